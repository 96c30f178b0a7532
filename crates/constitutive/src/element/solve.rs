//! The strain for which a law answers with the stresses that are prescribed.

use super::{COMPONENTS, Control, ElementError};

/// A component that does not reach its stress.
#[derive(Debug)]
pub(super) struct Unreached {
    component: usize,
    wanted: f64,
    found: f64,
}

impl Unreached {
    pub(super) fn at(self, leg: usize, increment: usize) -> ElementError {
        let Self { component, wanted, found } = self;
        if !found.is_finite() {
            return ElementError::NotFinite { leg, increment };
        }
        ElementError::Unreached { leg, increment, component: COMPONENTS[component], wanted, found }
    }
}

/// Share of the size of the stress to which a prescribed stress is met.
const TOLERANCE: f64 = 1e-13;
/// Share of the increment by which strains are varied.
const VARIATION: f64 = 1e-4;
const ITERATIONS: usize = 200;

/// The components whose stress is prescribed, and how far the answer is off.
struct Search<'a, F: Fn([f64; 6]) -> [f64; 6]> {
    answer: F,
    free: Vec<usize>,
    targets: &'a [f64; 6],
}

impl<F: Fn([f64; 6]) -> [f64; 6]> Search<'_, F> {
    fn misses(&self, strain: [f64; 6]) -> ([f64; 6], [f64; 6]) {
        let stress = (self.answer)(strain);
        let mut misses = [0.0; 6];
        for (miss, &component) in misses.iter_mut().zip(&self.free) {
            *miss = stress[component] - self.targets[component];
        }
        (stress, misses)
    }

    /// Changes of the misses with each free strain, over the change of strain.
    fn slopes(&self, strain: [f64; 6], misses: [f64; 6]) -> [[f64; 6]; 6] {
        let size = strain.iter().fold(0.0, |largest: f64, part| largest.max(part.abs()));
        let step = (VARIATION * size).max(1e-12);
        let mut slopes = [[0.0; 6]; 6];
        for (slope, &component) in slopes.iter_mut().zip(&self.free) {
            let mut varied = strain;
            varied[component] += step;
            let actual = varied[component] - strain[component];
            let (_, others) = self.misses(varied);
            *slope = std::array::from_fn(|i| (others[i] - misses[i]) / actual);
        }
        slopes
    }
}

fn size_of(misses: &[f64; 6]) -> f64 {
    misses.iter().map(|miss| miss * miss).sum::<f64>().sqrt()
}

/// Changes the slopes so that they explain the last step (Broyden): along it they are then right, also where the law has a kink.
fn correct(
    slopes: &mut [[f64; 6]; 6],
    free: &[usize],
    [from, to]: [[f64; 6]; 2],
    [before, after]: [[f64; 6]; 2],
) {
    let step: Vec<f64> = free.iter().map(|&component| to[component] - from[component]).collect();
    let square: f64 = step.iter().map(|part| part * part).sum();
    if square == 0.0 {
        return;
    }
    for i in 0..free.len() {
        let told: f64 = step.iter().zip(slopes.iter()).map(|(part, slope)| part * slope[i]).sum();
        let unexplained = (after[i] - before[i] - told) / square;
        for (slope, part) in slopes.iter_mut().zip(&step) {
            slope[i] += unexplained * part;
        }
    }
}

/// The best strain so far.
struct Best {
    strain: [f64; 6],
    stress: [f64; 6],
    misses: [f64; 6],
    size: f64,
    /// Slopes that may serve for the next step.
    slopes: Option<[[f64; 6]; 6]>,
    damping: f64,
}

/// What a step of the search led to.
#[derive(PartialEq)]
enum Outcome {
    Nearer,
    NoNearer,
    /// Even the shortest steps lead no nearer.
    Stuck,
}

impl Best {
    fn at<F: Fn([f64; 6]) -> [f64; 6]>(search: &Search<'_, F>, strain: [f64; 6]) -> Self {
        let (stress, misses) = search.misses(strain);
        Self { strain, stress, misses, size: size_of(&misses), slopes: None, damping: 1e-12 }
    }

    /// How far the misses are from what counts as met.
    fn excess(&self, targets: &[f64; 6]) -> f64 {
        let parts = self.stress.iter().chain(targets);
        let scale = parts.fold(0.0, |largest: f64, part| largest.max(part.abs()));
        if self.size == 0.0 { 0.0 } else { self.size / (TOLERANCE * scale) }
    }

    fn step<F: Fn([f64; 6]) -> [f64; 6]>(&mut self, search: &Search<'_, F>) -> Outcome {
        let are_new = self.slopes.is_none();
        let mut slopes = self.slopes.take().unwrap_or_else(|| search.slopes(self.strain, self.misses));
        let strain = moved(&search.free, self.strain, &slopes, &self.misses, self.damping);
        let (stress, misses) = search.misses(strain);
        let size = size_of(&misses);
        if size < self.size {
            correct(&mut slopes, &search.free, [self.strain, strain], [self.misses, misses]);
            // Slow progress asks for new slopes.
            self.slopes = (size < 0.5 * self.size).then_some(slopes);
            (self.strain, self.stress, self.misses, self.size) = (strain, stress, misses, size);
            self.damping = (self.damping * 0.1).max(1e-14);
            return Outcome::Nearer;
        }
        if are_new {
            self.damping = (self.damping * 10.0).max(1e-8);
        }
        if self.damping > 1e6 { Outcome::Stuck } else { Outcome::NoNearer }
    }

    /// The component that misses its target most.
    fn unreached(&self, free: &[usize], targets: &[f64; 6]) -> Unreached {
        let farther = |a: &usize, b: &usize| self.misses[*a].abs().total_cmp(&self.misses[*b].abs());
        let worst = (0..free.len()).max_by(farther).unwrap_or(0);
        let component = free.get(worst).copied().unwrap_or(0);
        Unreached { component, wanted: targets[component], found: self.stress[component] }
    }
}

/// The increment of strain that meets all targets, by damped least squares (Levenberg and Marquardt): at the strength the answer
/// may not depend on all strains, and Newton's method has no unique step.
pub(super) fn strain_for(
    answer: impl Fn([f64; 6]) -> [f64; 6],
    controls: &[Control; 6],
    targets: &[f64; 6],
    start: [f64; 6],
) -> Result<[f64; 6], Unreached> {
    let is_free = |component: &usize| matches!(controls[*component], Control::Stress(_));
    let free: Vec<usize> = (0..6).filter(is_free).collect();
    let mut strain = *targets;
    for &component in &free {
        strain[component] = start[component];
    }
    let search = Search { answer, free, targets };
    let mut best = Best::at(&search, strain);
    if let Some(component) = (0..6).find(|&component| !best.stress[component].is_finite()) {
        return Err(Unreached { component, wanted: targets[component], found: best.stress[component] });
    }
    for _ in 0..ITERATIONS {
        if best.excess(targets) <= 1.0 {
            break;
        }
        let outcome = best.step(&search);
        // Round-off of the law may keep it from coming nearer.
        if outcome == Outcome::Stuck || outcome == Outcome::NoNearer && best.excess(targets) <= 100.0 {
            break;
        }
    }
    if best.excess(targets) <= 100.0 {
        return Ok(best.strain);
    }
    Err(best.unreached(&search.free, targets))
}

/// The strain after a step of damped least squares.
fn moved(
    free: &[usize],
    strain: [f64; 6],
    slopes: &[[f64; 6]; 6],
    misses: &[f64; 6],
    damping: f64,
) -> [f64; 6] {
    let count = free.len();
    let dot = |a: &[f64; 6], b: &[f64; 6]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let mut matrix = [[0.0; 7]; 6];
    let largest = (0..count).map(|i| dot(&slopes[i], &slopes[i])).fold(0.0, f64::max);
    for i in 0..count {
        for j in 0..count {
            matrix[i][j] = dot(&slopes[i], &slopes[j]);
        }
        matrix[i][i] += damping * largest + f64::MIN_POSITIVE;
        matrix[i][6] = -dot(&slopes[i], misses);
    }
    let step = eliminated(matrix, count);
    let mut moved = strain;
    for (&component, change) in free.iter().zip(step) {
        moved[component] += change;
    }
    moved
}

/// Solution of a small symmetric positive system; its right side is column 6.
fn eliminated(mut matrix: [[f64; 7]; 6], count: usize) -> [f64; 6] {
    for column in 0..count {
        for row in column + 1..count {
            let factor = matrix[row][column] / matrix[column][column];
            let pivot = matrix[column];
            for (part, above) in matrix[row].iter_mut().zip(pivot).skip(column) {
                *part -= factor * above;
            }
        }
    }
    let mut solution = [0.0; 6];
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|column| matrix[row][column] * solution[column]).sum();
        solution[row] = (matrix[row][6] - known) / matrix[row][row];
    }
    solution
}
