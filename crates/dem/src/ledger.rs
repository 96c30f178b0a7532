//! The energy ledger: every loss is integrated from its own force and velocity.

use std::ops::AddAssign;

/// Energy lost since the start \[J; J/m in the plane\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    /// By sliding between grains.
    pub sliding: f64,
    /// By sliding at walls.
    pub sliding_at_walls: f64,
    /// In normal dashpots.
    pub normal_damping: f64,
    /// In tangential dashpots.
    pub tangential_damping: f64,
    /// By rolling and twisting resistance.
    pub rolling: f64,
}

impl Losses {
    /// All losses together.
    pub fn total(&self) -> f64 {
        self.sliding + self.sliding_at_walls + self.normal_damping + self.tangential_damping + self.rolling
    }

    pub(crate) fn to_array(self) -> [f64; 5] {
        [self.sliding, self.sliding_at_walls, self.normal_damping, self.tangential_damping, self.rolling]
    }

    pub(crate) fn from_array(values: [f64; 5]) -> Self {
        let [sliding, sliding_at_walls, normal_damping, tangential_damping, rolling] = values;
        Self { sliding, sliding_at_walls, normal_damping, tangential_damping, rolling }
    }
}

impl AddAssign for Losses {
    fn add_assign(&mut self, other: Self) {
        self.sliding += other.sliding;
        self.sliding_at_walls += other.sliding_at_walls;
        self.normal_damping += other.normal_damping;
        self.tangential_damping += other.tangential_damping;
        self.rolling += other.rolling;
    }
}

/// Adds up losses in a kernel; compiled to nothing unless `LEDGER`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally<const LEDGER: bool> {
    losses: Losses,
    at_wall: bool,
}

macro_rules! tally {
    ($($name:ident),*) => {$(
        /// Adds an energy \[J\] of this kind.
        #[inline(always)]
        pub fn $name(&mut self, energy: impl FnOnce() -> f64) {
            if LEDGER {
                self.losses.$name += energy();
            }
        }
    )*};
}

impl<const LEDGER: bool> Tally<LEDGER> {
    tally!(normal_damping, tangential_damping, rolling);

    /// Adds an energy lost by sliding \[J\].
    #[inline(always)]
    pub fn sliding(&mut self, energy: impl FnOnce() -> f64) {
        if LEDGER {
            let energy = energy();
            if self.at_wall {
                self.losses.sliding_at_walls += energy;
            } else {
                self.losses.sliding += energy;
            }
        }
    }

    /// From here on, sliding happens at walls.
    #[inline(always)]
    pub(crate) fn at_walls(&mut self) {
        self.at_wall = true;
    }

    /// Adds the losses of one contact.
    #[inline(always)]
    pub(crate) fn add(&mut self, losses: impl FnOnce() -> Losses) {
        if LEDGER {
            self.losses += losses();
        }
    }

    pub(crate) fn losses(&self) -> Losses {
        self.losses
    }
}
