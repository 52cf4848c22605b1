//! The twelve stages of eighth order of Dormand and Prince's method 8(5,3), with a fixed step h:
//!
//! ```text
//! k_i = h f(x + Σ_j a_ij k_j)        x(t + h) = x + Σ_i b_i k_i
//! ```
//!
//! What a step costs beside the equations is memory. Two slots take turns as the point at which the
//! equations are evaluated, since neighbours still read one while the next is put. When all slopes so far
//! are at hand, in stages 3, 5 and 8, the sums of the points behind the next one are begun with them. So
//! x and k_1 to k_8 are read for the last time in stage 8, and five slots hold all slopes and sums: each
//! is overwritten by what is made of it. A step reads 37 numbers and writes 27 of each component; with
//! all slopes kept it would be 69 and 23, in four slots more.
//!
//! Source: E. Hairer, S. P. Nørsett & G. Wanner, Solving Ordinary Differential Equations I (1993),
//! Sec. II.5; coefficients as in their program DOP853.
#![allow(clippy::excessive_precision, reason = "coefficients have the digits of the source")]

use super::step::{Slots, Step};
use crate::Scalar;

/// DOP853 without its error estimates.
pub(crate) struct Dop853;

/// The state, and from stage 8 on the sum that becomes the next one.
const X: usize = 0;
/// The points of even stages and of odd ones.
const EVEN: usize = 1;
const ODD: usize = 2;
/// Slopes k_1, k_4, …, k_7, and whatever stands in their places before and after.
const K_1: usize = 3;
const K_4: usize = 4;
const K_5: usize = 5;
const K_6: usize = 6;
const K_7: usize = 7;
/// The sum of point 5 stands where k_4 will, those of points 7 and 8 where k_6 and k_7 will.
const SUM_5: usize = K_4;
const SUM_7: usize = K_6;
const SUM_8: usize = K_7;
/// The sums of the last points, and the last slopes, stand where the first slopes stood.
const SUM_10: usize = K_1;
const SUM_11: usize = K_4;
const SUM_12: usize = K_5;
const K_9: usize = K_6;
const K_10: usize = K_7;

/// a_21; then a_ij of each further stage, zeros left out.
const A_2: f64 = 0.0526001519587677318785587544488;
/// j = 1, 2.
const A_3: [f64; 2] = [0.0197250569845378994544595329183, 0.0591751709536136983633785987549];
/// j = 1, 3.
const A_4: [f64; 2] = [0.0295875854768068491816892993775, 0.0887627564304205475450678981324];
/// j = 1, 3, 4.
const A_5: [f64; 3] = [
    0.241365134159266685502369798665,
    -0.884549479328286085344864962717,
    0.924834003261792003115737966543,
];
/// j = 1, 4, 5, and so on without a gap in the rows that follow.
const A_6: [f64; 3] = [
    0.037037037037037037037037037037,
    0.170828608729473871279604482173,
    0.125467687566822425016691814123,
];
const A_7: [f64; 4] = [
    0.037109375,
    0.170252211019544039314978060272,
    0.0602165389804559606850219397283,
    -0.017578125,
];
const A_8: [f64; 5] = [
    0.0370920001185047927108779319836,
    0.170383925712239993810214054705,
    0.107262030446373284651809199168,
    -0.0153194377486244017527936158236,
    0.00827378916381402288758473766002,
];
const A_9: [f64; 6] = [
    0.624110958716075717114429577812,
    -3.36089262944694129406857109825,
    -0.868219346841726006818189891453,
    27.5920996994467083049415600797,
    20.1540675504778934086186788979,
    -43.4898841810699588477366255144,
];
const A_10: [f64; 7] = [
    0.477662536438264365890433908527,
    -2.48811461997166764192642586468,
    -0.590290826836842996371446475743,
    21.2300514481811942347288949897,
    15.2792336328824235832596922938,
    -33.2882109689848629194453265587,
    -0.0203312017085086261358222928593,
];
const A_11: [f64; 8] = [
    -0.93714243008598732571704021658,
    5.18637242884406370830023853209,
    1.09143734899672957818500254654,
    -8.14978701074692612513997267357,
    -18.5200656599969598641566180701,
    22.7394870993505042818970056734,
    2.49360555267965238987089396762,
    -3.0467644718982195003823669022,
];
const A_12: [f64; 9] = [
    2.27331014751653820792359768449,
    -10.5344954667372501984066689879,
    -2.00087205822486249909675718444,
    -17.9589318631187989172765950534,
    27.9488845294199600508499808837,
    -2.85899827713502369474065508674,
    -8.87285693353062954433549289258,
    12.3605671757943030647266201528,
    0.643392746015763530355970484046,
];
/// b_i for i = 1, 6, 7, …, 12.
const B: [f64; 8] = [
    0.0542937341165687622380535766363,
    4.45031289275240888144113950566,
    1.89151789931450038304281599044,
    -5.8012039600105847814672114227,
    0.31116436695781989440891606237,
    -0.152160949662516078556178806805,
    0.201365400804030348374776537501,
    0.0447106157277725905176885569043,
];

impl Step for Dop853 {
    const AT: &'static [usize] = &[X, EVEN, ODD, EVEN, ODD, EVEN, ODD, EVEN, ODD, EVEN, ODD, EVEN];
    const SLOTS: usize = 8;

    #[inline(always)]
    fn put<const STAGE: usize, S: Scalar>(slots: &mut impl Slots<S>, f: S, h: f64) {
        let k = f * h;
        match STAGE {
            0 => {
                let x = slots.get(X);
                slots.set(EVEN, x + k * A_2);
                slots.set(K_1, k);
            }
            1 => {
                let (x, k_1) = (slots.get(X), slots.get(K_1));
                slots.set(ODD, x + sum([k_1, k], &A_3));
            }
            2 => {
                let (x, k_1) = (slots.get(X), slots.get(K_1));
                slots.set(EVEN, x + sum([k_1, k], &A_4));
                slots.set(SUM_5, x + sum([k_1, k], &A_5));
            }
            3 => {
                let x = slots.get(SUM_5);
                slots.set(ODD, x + k * A_5[2]);
                slots.set(K_4, k);
            }
            4 => {
                let (x, k_1, k_4) = (slots.get(X), slots.get(K_1), slots.get(K_4));
                slots.set(EVEN, x + sum([k_1, k_4, k], &A_6));
                slots.set(SUM_7, x + sum([k_1, k_4, k], &A_7));
                slots.set(SUM_8, x + sum([k_1, k_4, k], &A_8));
                slots.set(K_5, k);
            }
            5 => {
                let x = slots.get(SUM_7);
                slots.set(ODD, x + k * A_7[3]);
                slots.set(K_6, k);
            }
            6 => {
                let (x, k_6) = (slots.get(SUM_8), slots.get(K_6));
                slots.set(EVEN, x + sum([k_6, k], &A_8[3..]));
                slots.set(K_7, k);
            }
            7 => {
                let (x, k_1, k_4) = (slots.get(X), slots.get(K_1), slots.get(K_4));
                let (k_5, k_6, k_7) = (slots.get(K_5), slots.get(K_6), slots.get(K_7));
                let all = [k_1, k_4, k_5, k_6, k_7, k];
                slots.set(ODD, x + sum(all, &A_9));
                slots.set(SUM_10, x + sum(all, &A_10));
                slots.set(SUM_11, x + sum(all, &A_11));
                slots.set(SUM_12, x + sum(all, &A_12));
                slots.set(X, x + sum([k_1, k_6, k_7, k], &B));
            }
            8 => {
                let x = slots.get(SUM_10);
                slots.set(EVEN, x + k * A_10[6]);
                slots.set(K_9, k);
            }
            9 => {
                let (x, k_9) = (slots.get(SUM_11), slots.get(K_9));
                slots.set(ODD, x + sum([k_9, k], &A_11[6..]));
                slots.set(K_10, k);
            }
            10 => {
                let (x, k_9, k_10) = (slots.get(SUM_12), slots.get(K_9), slots.get(K_10));
                let next = slots.get(X);
                slots.set(EVEN, x + sum([k_9, k_10, k], &A_12[6..]));
                slots.set(X, next + sum([k_9, k_10, k], &B[4..]));
            }
            _ => {
                let next = slots.get(X);
                slots.set(X, next + k * B[7]);
            }
        }
    }
}

/// Σ a k of the first of some coefficients, in their order.
#[inline(always)]
fn sum<S: Scalar, const N: usize>(k: [S; N], a: &[f64]) -> S {
    let mut sum = k[0] * a[0];
    for n in 1..N {
        sum = sum + k[n] * a[n];
    }
    sum
}
