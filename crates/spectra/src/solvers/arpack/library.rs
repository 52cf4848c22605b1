//! ARPACK's implicitly restarted Lanczos method (dsaupd, dseupd): the largest eigenvalues of A.
//!
//! Mode 1, standard problem, largest algebraic eigenvalues, our own start vector. Source: Lehoucq,
//! Sorensen & Yang, ARPACK Users' Guide (SIAM, 1998).
//!
//! Two properties of the library shape this file. It keeps state in static variables, so a lock of
//! the whole process surrounds every solve. And when the Krylov space becomes invariant it goes on
//! from a random vector whose seed is such a static variable, so that a solve would depend on those
//! before it. We see that moment first: with v_j the newest vector of the Lanczos basis,
//! β_j = ⟨A v_j, v_{j−1}⟩ is then zero to rounding, and the basis v_1 … v_{j−1} is a result in itself.
#![expect(unsafe_code, reason = "ARPACK is a Fortran library; this file alone calls it")]

use std::ffi::{c_char, c_int};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use arpack_ng_sys::{dsaupd_c, dseupd_c};

use crate::error::SpectraError;
use crate::found::Eigenpairs;
use crate::progress::Asked;
use crate::solvers::arpack::operator::Operator;
use crate::vectors::column::dot;

/// Surrounds every call of ARPACK in this process.
static ARPACK: Mutex<()> = Mutex::new(());

const STANDARD_PROBLEM: *const c_char = c"I".as_ptr();
const LARGEST_ALGEBRAIC: *const c_char = c"LA".as_ptr();
const ALL_VECTORS: *const c_char = c"A".as_ptr();

/// What one solve is to do.
pub(crate) struct Settings {
    /// Eigenvalues wanted (nev), from 1 to N − 1.
    pub n_wanted: usize,
    /// Vectors of the Lanczos basis (ncv), more than `n_wanted` and at most N.
    pub n_basis: usize,
    /// Largest error bound of a converged eigenvalue θ, relative to |θ|.
    pub tolerance: f64,
    /// A basis is invariant when the next β_j is at most this.
    pub invariance: f64,
    /// Most products to spend.
    pub max_products: usize,
}

/// How a solve ended.
pub(crate) enum Outcome {
    /// All wanted eigenpairs.
    Converged(Eigenpairs),
    /// An orthonormal basis of a space that A maps into itself, and that contains the start vector.
    Invariant(Vec<Vec<f64>>),
    /// The products were spent; so many eigenpairs had converged.
    Exhausted(usize),
}

/// Largest eigenvalues of a symmetric operator, from one start vector; with the products spent. It is
/// asked at every product whether to go on, but not while another solve has the library.
///
/// Copies of a multiple eigenvalue may be missing: a Krylov space knows of only one.
pub(crate) fn largest(
    operator: &dyn Operator,
    start: Vec<f64>,
    settings: &Settings,
    asked: Asked<'_>,
) -> Result<(Outcome, usize), SpectraError> {
    let mut lanczos = Lanczos::new(start, settings)?;
    // ARPACK starts afresh at ido = 0, whatever state a panic of the operator left behind.
    let _alone = ARPACK.lock().unwrap_or_else(PoisonError::into_inner);
    let outcome = lanczos.iterate(operator, settings, asked)?;
    Ok((outcome, lanczos.products))
}

/// ARPACK's arguments, named as in its documentation.
struct Lanczos {
    n: usize,
    size: c_int,
    nev: c_int,
    ncv: c_int,
    tol: f64,
    resid: Vec<f64>,
    v: Vec<f64>,
    iparam: [c_int; 11],
    ipntr: [c_int; 11],
    workd: Vec<f64>,
    workl: Vec<f64>,
    lworkl: c_int,
    products: usize,
}

impl Lanczos {
    fn new(start: Vec<f64>, settings: &Settings) -> Result<Self, SpectraError> {
        let (n, n_wanted, n_basis) = (start.len(), settings.n_wanted, settings.n_basis);
        assert!(0 < n_wanted && n_wanted < n_basis && n_basis <= n, "{n_wanted} {n_basis} {n}");
        let to_int = |count: usize| {
            c_int::try_from(count)
                .map_err(|_| SpectraError::TooLargeForArpack { n_nodes: n, n_basis })
        };
        let lworkl = to_int(n_basis * (n_basis + 8))?;
        // Each restart costs at most ncv − nev products, after ncv for the first basis.
        let restarts = settings.max_products.saturating_sub(n_basis) / (n_basis - n_wanted);
        let mut iparam = [0; 11];
        iparam[0] = 1; // exact shifts
        iparam[2] = to_int(restarts.clamp(1, 1_000_000))?;
        iparam[3] = 1; // block size
        iparam[6] = 1; // mode 1: A x = θ x
        Ok(Self {
            n,
            size: to_int(n)?,
            nev: to_int(n_wanted)?,
            ncv: to_int(n_basis)?,
            tol: settings.tolerance,
            resid: start,
            v: vec![0.0; n * n_basis],
            iparam,
            ipntr: [0; 11],
            workd: vec![0.0; 3 * n],
            workl: vec![0.0; lworkl as usize],
            lworkl,
            products: 0,
        })
    }

    /// The reverse-communication loop: dsaupd asks for products until it has converged.
    fn iterate(
        &mut self,
        operator: &dyn Operator,
        settings: &Settings,
        asked: Asked<'_>,
    ) -> Result<Outcome, SpectraError> {
        let mut x = vec![0.0; self.n];
        let mut ido = 0;
        let mut info = 1; // `resid` holds our start vector
        loop {
            self.step(&mut ido, &mut info);
            let [from, to] = [self.ipntr[0], self.ipntr[1]];
            match ido {
                // ARPACK wants its start vector in the range of A, where ours is; a random one in
                // its place, after an invariant space, is discarded with the next product.
                -1 => self.workd.copy_within(column(from, self.n), to as usize - 1),
                1 if self.products == settings.max_products => return Ok(Outcome::Exhausted(0)),
                1 => {
                    self.products += 1;
                    asked(self.products)?;
                    x.copy_from_slice(&self.workd[column(from, self.n)]);
                    let y = &mut self.workd[column(to, self.n)];
                    operator.apply(&x, y);
                    if let Some(basis) = invariant_basis(&self.v, &x, y, settings.invariance) {
                        return Ok(Outcome::Invariant(basis));
                    }
                }
                _ => break,
            }
        }
        match (ido, info) {
            (99, 0) => self.extract().map(Outcome::Converged),
            (99, 1) => Ok(Outcome::Exhausted(self.iparam[4] as usize)),
            _ => Err(SpectraError::ArpackFailed { routine: "dsaupd", info }),
        }
    }

    /// One call of dsaupd.
    fn step(&mut self, ido: &mut c_int, info: &mut c_int) {
        // SAFETY: every array has the length that dsaupd's documentation asks for (resid n, v n·ncv,
        // iparam 11, ipntr 11, workd 3n, workl ncv·(ncv+8)), lives as long as `self` and is neither
        // moved nor resized between calls; the caller holds the lock.
        unsafe {
            dsaupd_c(
                ido,
                STANDARD_PROBLEM,
                self.size,
                LARGEST_ALGEBRAIC,
                self.nev,
                self.tol,
                self.resid.as_mut_ptr(),
                self.ncv,
                self.v.as_mut_ptr(),
                self.size,
                self.iparam.as_mut_ptr(),
                self.ipntr.as_mut_ptr(),
                self.workd.as_mut_ptr(),
                self.workl.as_mut_ptr(),
                self.lworkl,
                info,
            );
        }
    }

    /// The converged eigenpairs, by dseupd.
    fn extract(&mut self) -> Result<Eigenpairs, SpectraError> {
        let n_wanted = self.nev as usize;
        let mut select: Vec<c_int> = vec![0; self.ncv as usize];
        let mut ascending = vec![0.0; n_wanted];
        let mut z = vec![0.0; self.n * n_wanted];
        let mut info = 0;
        // SAFETY: the arguments from `bmat` on are those of the dsaupd call just before, as dseupd
        // requires; select has ncv elements (its pointer is to mutable memory, for dseupd uses it
        // as workspace), the values nev and z n·nev; the caller holds the lock.
        unsafe {
            dseupd_c(
                1,
                ALL_VECTORS,
                select.as_mut_ptr().cast_const(),
                ascending.as_mut_ptr(),
                z.as_mut_ptr(),
                self.size,
                0.0,
                STANDARD_PROBLEM,
                self.size,
                LARGEST_ALGEBRAIC,
                self.nev,
                self.tol,
                self.resid.as_mut_ptr(),
                self.ncv,
                self.v.as_mut_ptr(),
                self.size,
                self.iparam.as_mut_ptr(),
                self.ipntr.as_mut_ptr(),
                self.workd.as_mut_ptr(),
                self.workl.as_mut_ptr(),
                self.lworkl,
                &mut info,
            );
        }
        if info != 0 {
            return Err(SpectraError::ArpackFailed { routine: "dseupd", info });
        }
        let n_converged = self.iparam[4] as usize;
        Ok(Eigenpairs {
            values: ascending[..n_converged].iter().rev().copied().collect(),
            vectors: z.chunks(self.n).take(n_converged).rev().map(<[f64]>::to_vec).collect(),
        })
    }
}

/// The n elements of `workd` from a one-based pointer on.
fn column(one_based: c_int, n: usize) -> Range<usize> {
    let start = one_based as usize - 1;
    start..start + n
}

/// The vectors before x = v_j in the Lanczos basis, when |⟨y, v_{j−1}⟩| says that they span an
/// invariant space; y = A x.
fn invariant_basis(v: &[f64], x: &[f64], y: &[f64], invariance: f64) -> Option<Vec<Vec<f64>>> {
    let columns = || v.chunks(x.len());
    let j = columns().position(|column| column == x).expect("dsaupd multiplies its newest vector");
    let previous = columns().nth(j.checked_sub(1)?)?;
    (dot(y, previous).abs() <= invariance).then(|| columns().take(j).map(<[f64]>::to_vec).collect())
}
