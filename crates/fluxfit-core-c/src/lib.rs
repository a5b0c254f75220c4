//! The estimators of `fluxfit-core` for programs in C, in `f32`: `include/fluxfit_core.h` has the declarations.
//!
//! The caller gives the memory: structures of a fixed size, in which an estimator is created in place. Nothing is allocated, nothing
//! fails; a null pointer is left alone, and what is no number is left out as a gap.
//!
//! This is the only crate that allows `unsafe`: names must be exported, and pointers from C be used.
#![allow(unsafe_code)]

use fluxfit_core::{BlockRls, BlockRlsSettings, Ekf, EkfSettings, PARAMETERS, Period};

/// Bytes of the memory for block least squares; the header has the same number.
pub const RLS_BYTES: usize = 512;

/// Bytes of the memory for a Kalman filter; the header has the same number.
pub const EKF_BYTES: usize = 768;

/// Memory for block least squares.
#[repr(C, align(8))]
#[derive(Debug)]
pub struct FluxfitRls {
    bytes: [u8; RLS_BYTES],
}

/// Memory for a Kalman filter.
#[repr(C, align(8))]
#[derive(Debug)]
pub struct FluxfitEkf {
    bytes: [u8; EKF_BYTES],
}

/// rs, ld, lq, psi_f in SI units, and their standard errors.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct FluxfitEstimate {
    /// Values.
    pub value: [f32; PARAMETERS],
    /// Standard errors.
    pub standard_error: [f32; PARAMETERS],
}

/// Does not compile unless the memory is enough for what is put into it.
const FITS: [(); 1] = [(); (size_of::<BlockRls<f32>>() <= RLS_BYTES
    && align_of::<BlockRls<f32>>() <= align_of::<FluxfitRls>()
    && size_of::<Ekf<f32>>() <= EKF_BYTES
    && align_of::<Ekf<f32>>() <= align_of::<FluxfitEkf>()) as usize];
const _: [(); 1] = FITS;

/// Creates block least squares with gated forgetting; `nominal` has rs, ld, lq and psi_f within a factor of some tens.
///
/// # Safety
/// `rls` points to memory of its type, `nominal` to four numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_rls_init(rls: *mut FluxfitRls, nominal: *const f32) {
    if rls.is_null() || nominal.is_null() {
        return;
    }
    // SAFETY: by the contract above both point to enough memory; the constant FITS checks size and alignment.
    unsafe {
        let nominal = *nominal.cast::<[f32; PARAMETERS]>();
        rls.cast::<BlockRls<f32>>().write(BlockRls::new(BlockRlsSettings::new(nominal)));
    }
}

/// Begins at a measured current, A: at the start, and after a gap.
///
/// # Safety
/// `rls` was created by [`fluxfit_rls_init`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_rls_begin(rls: *mut FluxfitRls, id: f32, iq: f32) {
    // SAFETY: by the contract above.
    if let Some(rls) = unsafe { rls.cast::<BlockRls<f32>>().as_mut() } {
        rls.begin([id, iq]);
    }
}

/// Goes on by a period: voltage, V, in the frame at its middle, mean speed, electrical rad/s, length, s, and the current, A, at its end.
/// Returns 1 if the estimate changed.
///
/// # Safety
/// `rls` was created by [`fluxfit_rls_init`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_rls_advance(rls: *mut FluxfitRls, ud: f32, uq: f32, omega_e: f32, length: f32, id: f32, iq: f32) -> i32 {
    // SAFETY: by the contract above.
    match unsafe { rls.cast::<BlockRls<f32>>().as_mut() } {
        Some(rls) => i32::from(rls.advance(&Period { u: [ud, uq], omega_e, length }, [id, iq])),
        None => 0,
    }
}

/// What is known.
///
/// # Safety
/// `rls` was created by [`fluxfit_rls_init`], `estimate` points to memory of its type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_rls_estimate(rls: *const FluxfitRls, estimate: *mut FluxfitEstimate) {
    // SAFETY: by the contract above.
    if let (Some(rls), Some(estimate)) = unsafe { (rls.cast::<BlockRls<f32>>().as_ref(), estimate.as_mut()) } {
        let known = rls.estimate();
        *estimate = FluxfitEstimate { value: known.value, standard_error: known.standard_error };
    }
}

/// Whether the last half second excited the parameters: 1 or 0.
///
/// # Safety
/// `rls` was created by [`fluxfit_rls_init`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_rls_is_excited(rls: *const FluxfitRls) -> i32 {
    // SAFETY: by the contract above.
    unsafe { rls.cast::<BlockRls<f32>>().as_ref() }.map_or(0, |rls| i32::from(rls.is_excited()))
}

/// Creates a Kalman filter that starts at `start`, which must be near the motor: those of block least squares. `rated_current` in A,
/// `unknown_voltage` in V, from commissioning. `tracks`: 1 for parameters that drift and step, 0 for constant ones.
///
/// # Safety
/// `ekf` points to memory of its type, `start` to four numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_ekf_init(ekf: *mut FluxfitEkf, start: *const f32, rated_current: f32, unknown_voltage: f32, tracks: i32) {
    if ekf.is_null() || start.is_null() {
        return;
    }
    // SAFETY: by the contract above both point to enough memory; the constant FITS checks size and alignment.
    unsafe {
        let start = *start.cast::<[f32; PARAMETERS]>();
        let settings = if tracks == 0 { EkfSettings::constant(start, rated_current) } else { EkfSettings::tracking(start, rated_current) };
        ekf.cast::<Ekf<f32>>().write(Ekf::new(EkfSettings { unknown_voltage, ..settings }, [1.0; PARAMETERS]));
    }
}

/// Begins at a measured current, A: at the start, and after a gap. What is known of the parameters stays.
///
/// # Safety
/// `ekf` was created by [`fluxfit_ekf_init`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_ekf_begin(ekf: *mut FluxfitEkf, id: f32, iq: f32) {
    // SAFETY: by the contract above.
    if let Some(ekf) = unsafe { ekf.cast::<Ekf<f32>>().as_mut() } {
        ekf.begin([id, iq]);
    }
}

/// Goes on by a period, as [`fluxfit_rls_advance`].
///
/// # Safety
/// `ekf` was created by [`fluxfit_ekf_init`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_ekf_advance(ekf: *mut FluxfitEkf, ud: f32, uq: f32, omega_e: f32, length: f32, id: f32, iq: f32) {
    // SAFETY: by the contract above.
    if let Some(ekf) = unsafe { ekf.cast::<Ekf<f32>>().as_mut() } {
        ekf.advance(&Period { u: [ud, uq], omega_e, length }, [id, iq]);
    }
}

/// Notes whether the last half second excited the parameters, as [`fluxfit_rls_is_excited`] tells: while it does not (0), what one
/// operating point does not tell is held.
///
/// # Safety
/// `ekf` was created by [`fluxfit_ekf_init`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_ekf_note_excitation(ekf: *mut FluxfitEkf, is_excited: i32) {
    // SAFETY: by the contract above.
    if let Some(ekf) = unsafe { ekf.cast::<Ekf<f32>>().as_mut() } {
        ekf.note_excitation(is_excited != 0);
    }
}

/// What is known.
///
/// # Safety
/// `ekf` was created by [`fluxfit_ekf_init`], `estimate` points to memory of its type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluxfit_ekf_estimate(ekf: *const FluxfitEkf, estimate: *mut FluxfitEstimate) {
    // SAFETY: by the contract above.
    if let (Some(ekf), Some(estimate)) = unsafe { (ekf.cast::<Ekf<f32>>().as_ref(), estimate.as_mut()) } {
        *estimate = FluxfitEstimate { value: ekf.values(), standard_error: ekf.standard_errors() };
    }
}
