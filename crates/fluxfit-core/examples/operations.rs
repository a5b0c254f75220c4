//! Operations per sample of each estimator, counted by a number that counts.
// Numbers on standard output are what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_core::{BlockRls, BlockRlsSettings, Ekf, EkfSettings, Number, Period, Real, period::current_after};
use std::{
    cell::RefCell,
    collections::BTreeMap,
    ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign},
};

thread_local! {
    static COUNTS: RefCell<BTreeMap<&'static str, u64>> = const { RefCell::new(BTreeMap::new()) };
}

fn count(operation: &'static str) {
    COUNTS.with_borrow_mut(|counts| *counts.entry(operation).or_default() += 1);
}

#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct Counted(f32);

macro_rules! counted {
    ($($trait:ident $method:ident $operation:literal),*) => { $(
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                count($operation);
                Self(self.0.$method(other.0))
            }
        }
    )* };
}
counted!(Add add "additions", Sub sub "additions", Mul mul "multiplications", Div div "divisions");

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Counted {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Counted {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Number for Counted {
    const ZERO: Self = Self(0.0);
    const ONE: Self = Self(1.0);
    fn of(value: f64) -> Self {
        Self(value as f32)
    }
    fn largest(self) -> f64 {
        f64::from(self.0)
    }
    fn sqrt(self) -> Self {
        count("square roots");
        Self(self.0.sqrt())
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn sin_cos(self) -> (Self, Self) {
        count("sines with cosines");
        let (sin, cos) = self.0.sin_cos();
        (Self(sin), Self(cos))
    }
    fn ln(self) -> Self {
        count("logarithms");
        Self(self.0.ln())
    }
    fn exp_m1(self) -> Self {
        count("exponentials");
        Self(self.0.exp_m1())
    }
    fn if_above(self, other: Self, then: Self, otherwise: Self) -> Self {
        if self > other { then } else { otherwise }
    }
    fn larger(self, other: Self) -> Self {
        self.if_above(other, self, other)
    }
    fn smaller(self, other: Self) -> Self {
        other.if_above(self, self, other)
    }
}

impl Real for Counted {
    fn to_f64(self) -> f64 {
        f64::from(self.0)
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

/// Periods that are counted: 200 blocks, so that the equations of a block count with their share.
const PERIODS: u32 = 10_000;

fn counted(name: &str, mut advance: impl FnMut(&Period<Counted>, [Counted; 2])) {
    let truth = [0.958, 5.25e-3, 12e-3, 0.1827];
    let mut i = [0.0, 9.0];
    let mut take = |k: u32| {
        let id = if k / 2500 % 2 == 1 { -2.0 } else { 0.0 };
        let u = [1.3 * id - 45.0 - 3.0 * i[0], 85.0 + 2.0 * id - 7.0 * (i[1] - 9.0)];
        let period = Period { u, omega_e: 419.0, length: 1e-4 };
        i = current_after(&truth, i, &period);
        let period = Period { u: u.map(Counted::of), omega_e: Counted::of(419.0), length: Counted::of(1e-4) };
        advance(&period, i.map(Counted::of));
    };
    // Whatever happens but once.
    (0..PERIODS).for_each(&mut take);
    COUNTS.with_borrow_mut(BTreeMap::clear);
    (PERIODS..2 * PERIODS).for_each(take);
    let text = COUNTS.with_borrow(|counts| {
        let shown = counts.iter().map(|(operation, count)| format!("{:.1} {operation}", *count as f64 / f64::from(PERIODS)));
        shown.collect::<Vec<_>>().join(", ")
    });
    println!("{name}: {text}");
}

fn main() {
    let nominal = [1.0, 5e-3, 1e-2, 0.2].map(Counted::of);
    let mut rls = BlockRls::new(BlockRlsSettings::new(nominal));
    counted("block least squares", |period, i| {
        rls.advance(period, i);
    });
    let mut ekf = Ekf::new(EkfSettings::tracking(nominal, Counted::of(10.0)), [Counted::ONE; 4]);
    counted("Kalman filter, tracking", |period, i| ekf.advance(period, i));
    let mut ekf = Ekf::new(EkfSettings::constant(nominal, Counted::of(10.0)), [Counted::ONE; 4]);
    counted("Kalman filter, constant", |period, i| ekf.advance(period, i));
}
