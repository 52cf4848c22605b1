#![allow(missing_docs)]
//! Fixtures for measuring; scratch.
use graph::{
    Network,
    generators::{LinkProbability, communities},
};
use std::io::Write;

pub fn planted(n: usize) -> Network {
    // 8 communities, mean degree 20, mixing: 80 % of links inside.
    let size = n / 8;
    let within = 16.0 / size as f64;
    let between = 4.0 / (n - size) as f64;
    communities(&[size; 8], &LinkProbability::Uniform { within, between }, 1).unwrap()
}
fn unit(n: usize, links: Vec<(usize, usize)>) -> Network {
    let links: Vec<_> = links.into_iter().map(|(i, j)| (i, j, 1.0)).collect();
    Network::undirected((1..=n).map(|i| i.to_string()).collect(), &links).unwrap()
}
pub fn grid(side: usize) -> Network {
    let mut l = vec![];
    for i in 0..side {
        for j in 0..side {
            if i + 1 < side {
                l.push((i * side + j, (i + 1) * side + j));
            }
            if j + 1 < side {
                l.push((i * side + j, i * side + j + 1));
            }
        }
    }
    unit(side * side, l)
}
pub fn path(n: usize) -> Network {
    unit(n, (1..n).map(|i| (i - 1, i)).collect())
}
pub fn cliques(n: usize) -> Network {
    let c = n / 5;
    let mut l = vec![];
    for k in 0..c {
        for i in 0..5 {
            for j in 0..i {
                l.push((5 * k + i, 5 * k + j));
            }
        }
        l.push((5 * k + 4, 5 * ((k + 1) % c)));
    }
    unit(5 * c, l)
}
pub fn barabasi(n: usize, m: usize) -> Network {
    let mut s = 12345u64;
    let mut ends: Vec<usize> = vec![];
    let mut l = vec![];
    let mut next = || {
        s ^= s << 13;
        s ^= s >> 7;
        s ^= s << 17;
        s
    };
    for i in 0..=m {
        for j in 0..i {
            l.push((i, j));
            ends.push(i);
            ends.push(j);
        }
    }
    for i in m + 1..n {
        let mut t: Vec<usize> = vec![];
        while t.len() < m {
            let e = ends[(next() >> 11) as usize % ends.len()];
            if !t.contains(&e) {
                t.push(e);
            }
        }
        for e in t {
            l.push((i, e));
            ends.push(i);
            ends.push(e);
        }
    }
    unit(n, l)
}
pub fn named(name: &str, n: usize) -> Network {
    match name {
        "planted" => planted(n),
        "grid" => grid((n as f64).sqrt() as usize),
        "path" => path(n),
        "cliques" => cliques(n),
        "cube" => {
            let d = n.trailing_zeros();
            let mut l = vec![];
            for i in 0..n {
                for k in 0..d {
                    let j = i ^ (1 << k);
                    if i < j {
                        l.push((i, j));
                    }
                }
            }
            unit(n, l)
        }
        "bip" => {
            let mut l = vec![];
            for i in 0..12 {
                for j in 12..19 {
                    l.push((i, j));
                }
            }
            unit(19, l)
        }
        "star" => unit(n, (1..n).map(|i| (0, i)).collect()),
        "torus" => {
            let q = (n as f64).sqrt() as usize;
            let mut l = vec![];
            for i in 0..q {
                for j in 0..q {
                    l.push((i * q + j, i * q + (j + 1) % q));
                    l.push((i * q + j, ((i + 1) % q) * q + j));
                }
            }
            unit(q * q, l)
        }
        "ba" => barabasi(n, 5),
        _ => panic!("{name}"),
    }
}
#[allow(dead_code)]
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let net = named(&a[1], a[2].parse().unwrap());
    let adj = net.adjacency();
    let mut f = std::io::BufWriter::new(std::fs::File::create(&a[3]).unwrap());
    f.write_all(&(adj.rows() as u64).to_le_bytes()).unwrap();
    f.write_all(&(adj.nnz() as u64).to_le_bytes()).unwrap();
    for &p in adj.indptr().raw_storage() {
        f.write_all(&(p as u32).to_le_bytes()).unwrap();
    }
    for &j in adj.indices() {
        f.write_all(&j.to_le_bytes()).unwrap();
    }
}
