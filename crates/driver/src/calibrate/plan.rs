//! What is run.

use super::Task;
use crate::Effort;

/// Which samples are sheared, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Grains in a sample.
    pub grains: usize,
    /// Number of seeds: 1, 2, and so on.
    pub seeds: u64,
    /// Normal stresses over the modulus of the packing \[-\]; the first is that of all inertial numbers.
    pub levels: Vec<f64>,
    /// Inertial numbers in rising order.
    pub inertial_numbers: Vec<f64>,
    /// Inertial number at which other stresses are tried; one of those above.
    pub other_stresses_at: f64,
    /// Shear strain before a slow flow is steady.
    pub settle: f64,
    /// Shear strain over which a slow flow is measured.
    pub measure: f64,
}

impl Plan {
    /// The plan of an effort: quick takes about a minute on two cores in the plane.
    pub fn of(effort: Effort) -> Self {
        match effort {
            Effort::Quick => Self {
                grains: 200,
                seeds: 3,
                levels: vec![1e-3, 3e-4],
                inertial_numbers: vec![0.01, 0.03, 0.1, 0.2],
                other_stresses_at: 0.03,
                settle: 1.0,
                measure: 1.5,
            },
            Effort::Full => Self {
                grains: 1000,
                seeds: 6,
                levels: vec![1e-3, 3e-4, 1e-4],
                inertial_numbers: vec![1e-3, 3e-3, 0.01, 0.03, 0.1, 0.2, 0.3],
                other_stresses_at: 0.01,
                settle: 1.0,
                measure: 3.0,
            },
        }
    }

    /// Shear strain before a flow is steady, and at its end. A fast flow takes several strains to find its density: both
    /// grow with the inertial number, and a fast flow costs less per strain.
    pub(crate) fn strains(&self, inertial_number: f64) -> (f64, f64) {
        let longer = 1.0 + 20.0 * inertial_number;
        (self.settle * longer, (self.settle + self.measure) * longer)
    }

    pub(super) fn seeds(&self) -> impl Iterator<Item = u64> + use<> {
        1..=self.seeds
    }

    pub(super) fn slowest(&self) -> f64 {
        self.inertial_numbers.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Stress and inertial number of every run.
    pub(super) fn runs(&self) -> Vec<(f64, f64)> {
        let mut runs = Vec::new();
        for (k, &level) in self.levels.iter().enumerate() {
            let tried =
                self.inertial_numbers.iter().filter(|&&number| k == 0 || number == self.other_stresses_at);
            runs.extend(tried.map(|&number| (level, number)));
        }
        runs
    }

    /// All runs of all seeds, the longest first.
    pub(super) fn tasks(&self) -> Vec<Task> {
        let mut runs = self.runs();
        runs.sort_by(|a, b| (a.1 * a.0.sqrt()).total_cmp(&(b.1 * b.0.sqrt())));
        let mut tasks = Vec::new();
        for (level, number) in runs {
            tasks.extend(self.seeds().map(|seed| Task { seed, level, inertial_number: Some(number) }));
        }
        let level = self.levels.first().copied().unwrap_or(1e-3);
        tasks.extend(self.seeds().map(|seed| Task { seed, level, inertial_number: None }));
        tasks
    }
}
