//! scratch
#[allow(dead_code)]
#[path = "fixture.rs"]
mod fixture;
use std::time::Instant;
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.split_whitespace().collect();
    (f[13].parse::<f64>().unwrap()) / 100.0
}
fn run<const B: usize>(ip: &[usize], ix: &[u32], n: usize, reps: usize) {
    let x = vec![[1.0f64; B]; n];
    let mut y = vec![[0.0f64; B]; n];
    let g: Vec<f64> = (0..n).map(|i| i as f64).collect();
    let (t, c) = (Instant::now(), cpu());
    for _ in 0..reps {
        for i in 0..n {
            let mut s = [0.0; B];
            for &j in &ix[ip[i]..ip[i + 1]] {
                let xj = &x[j as usize];
                for v in 0..B {
                    s[v] += xj[v];
                }
            }
            for v in 0..B {
                y[i][v] = g[i] * s[v] - y[i][v] + 0.3 * x[i][v];
            }
        }
    }
    let c = cpu() - c;
    println!(
        "B={B} wall {:.2} cpu {c:.2}: cpu ns per link and vector {:.3}",
        t.elapsed().as_secs_f64(),
        c * 1e9 / (reps * B * ix.len()) as f64
    );
    assert!(y[0][0] != 1.5);
}
fn run2<const B: usize, const U: usize>(ip: &[usize], ix: &[u32], n: usize, reps: usize) {
    let x = vec![[1.0f64; B]; n];
    let mut y = vec![[0.0f64; B]; n];
    let g: Vec<f64> = (0..n).map(|i| i as f64).collect();
    let c = cpu();
    for _ in 0..reps {
        for i in 0..n {
            let mut s = [[0.0; B]; U];
            let (fours, rest) = ix[ip[i]..ip[i + 1]].as_chunks::<U>();
            for four in fours {
                for u in 0..U {
                    let xj = &x[four[u] as usize];
                    for v in 0..B {
                        s[u][v] += xj[v];
                    }
                }
            }
            for &j in rest {
                let xj = &x[j as usize];
                for v in 0..B {
                    s[0][v] += xj[v];
                }
            }
            for u in 1..U {
                for v in 0..B {
                    s[0][v] += s[u][v];
                }
            }
            for v in 0..B {
                y[i][v] = g[i] * s[0][v] - y[i][v] + 0.3 * x[i][v];
            }
        }
    }
    let c = cpu() - c;
    println!(
        "B={B} U={U} : cpu ns per link and vector {:.3}",
        c * 1e9 / (reps * B * ix.len()) as f64
    );
    assert!(y[0][0] != 1.5);
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let net = fixture::named(&a[1], a[2].parse().unwrap());
    let adj = net.adjacency();
    let ip = adj.indptr().raw_storage().to_vec();
    let ix = adj.indices();
    let n = adj.rows();
    let reps = (400_000_000 / ix.len()).max(2) * 1;
    for _ in 0..2 {
        run2::<1, 4>(&ip, ix, n, reps);
        run2::<1, 8>(&ip, ix, n, reps);
        run2::<2, 4>(&ip, ix, n, reps);
        run2::<4, 2>(&ip, ix, n, reps / 2);
        run2::<4, 4>(&ip, ix, n, reps / 2);
        run::<1>(&ip, ix, n, reps);
        run::<2>(&ip, ix, n, reps);
        run::<4>(&ip, ix, n, reps / 2);
        run::<8>(&ip, ix, n, reps / 4 + 1);
    }
}
