//! x = n π/2 + r of huge x: as many bits of 2/π are multiplied as the size of x makes count.
//!
//! Source: M. H. Payne & R. N. Hanek, SIGNUM Newsletter 18, 19 (1983).

use super::reduced::Reduced;
use super::two;

/// 2/π behind the point, after 64 zeros.
const TWO_OVER_PI: [u64; 21] = [
    0,
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
];

/// π/2 in two parts.
const HALF_PI: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];

/// A number of 256 bits, the most significant word first.
type Wide = [u64; 4];

/// The last two bits of n, and r in two parts, of an |x| above 2^20.
pub(super) fn reduced(x: f64) -> Reduced {
    if !x.is_finite() {
        return Reduced { n: 0, r: f64::NAN, r_low: f64::NAN };
    }
    let bits = x.abs().to_bits();
    let mantissa = (bits & ((1 << 52) - 1)) | (1 << 52);
    // |x| = m 2^e, e ≥ −32. Bits of 2/π before the first of the window make multiples of 4.
    let exponent = (bits >> 52) as usize + 64 - 1075;
    let turns = times(window(exponent - 1 - 1), mantissa);
    let quadrant = turns[0] >> 62;
    let fraction = [turns[0] << 2 >> 2, turns[1], turns[2], turns[3]];
    let above_half = fraction[0] >> 61 == 1;
    let rest = if above_half { negated(fraction) } else { fraction };
    let (f, f_low) = in_two(rest);
    let (p, p_low) = two::product(f, HALF_PI[0]);
    let (r, r_low) = two::ordered_sum(p, p_low + (f * HALF_PI[1] + f_low * HALF_PI[0]));
    let n = quadrant + u64::from(above_half);
    let flip = above_half != (x < 0.0);
    let n = if x < 0.0 { n.wrapping_neg() } else { n };
    if flip { Reduced { n, r: -r, r_low: -r_low } } else { Reduced { n, r, r_low } }
}

/// 256 bits of the table from one on.
fn window(first: usize) -> Wide {
    let (word, bit) = (first / 64, first % 64);
    std::array::from_fn(|k| {
        let here = TWO_OVER_PI[word + k] << bit;
        if bit == 0 { here } else { here | (TWO_OVER_PI[word + k + 1] >> (64 - bit)) }
    })
}

/// The last 256 bits of a product.
fn times(wide: Wide, factor: u64) -> Wide {
    let mut product = [0; 4];
    let mut carry = 0u128;
    for k in (0..4).rev() {
        carry += u128::from(wide[k]) * u128::from(factor);
        product[k] = carry as u64;
        carry >>= 64;
    }
    product
}

/// 2^254 minus a number.
fn negated(wide: Wide) -> Wide {
    let mut negated = wide.map(|word| !word);
    for k in (0..4).rev() {
        let (word, carry) = negated[k].overflowing_add(1);
        negated[k] = word;
        if !carry {
            break;
        }
    }
    negated[0] = negated[0] << 2 >> 2;
    negated
}

/// A fraction of 2^254 as a double and what that lacks.
fn in_two(wide: Wide) -> (f64, f64) {
    let Some(word) = wide.iter().position(|word| *word != 0) else { return (0.0, 0.0) };
    let zeros = wide[word].leading_zeros();
    let at = |k: usize| wide.get(word + k).copied().unwrap_or(0);
    let joined = |k: usize| {
        if zeros == 0 { at(k) } else { (at(k) << zeros) | (at(k + 1) >> (64 - zeros)) }
    };
    let (first, second) = (joined(0), joined(1));
    // The first bit has the weight 2^1 in front of all 256 bits, of which two are the quadrant's.
    let power = |behind: u64| f64::from_bits((1023 + 2 - behind) << 52);
    let behind = 64 * word as u64 + u64::from(zeros) + 53;
    let high = (first >> 11) as f64 * power(behind);
    let low = (((first & 0x7ff) << 53) | (second >> 11)) as f64 * power(behind + 64);
    (high, low)
}
