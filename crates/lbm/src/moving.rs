//! Obstacles that move: cells are covered and uncovered, and links found again.
//!
//! An uncovered cell gets the equilibrium at the mean density of the fluid cells around it and the velocity of the body
//! that left it, and their mean deviation from equilibrium \[Caiazzo2008\]. Mass at the density at rest comes and goes with the
//! cells that a body covers, whose number is the same on average. What is over it the body gives back and takes ([`crate::mass`]):
//! the mean density stays.

use crate::boundary::{Builder, Seen, mirrored, set_velocity};
use crate::lattice::Lattice;
use crate::lbm::Lbm;
use crate::mass::counted;
use crate::obstacle::{Domain, Range, cell_index, cells_of};
use crate::open::equilibrium;
use crate::openings::open_faces;
use crate::real::Real;
use granular_core::{Accepts, Dim, Linear, Motion, ObstacleMotion, Provides, Solver, StepError, Vector};

/// Fastest motion of a surface \[cells per step\]: the speed of sound.
pub(crate) const FASTEST: f64 = 0.577;

impl<L: Lattice<Q>, const Q: usize, T: Real> Provides<ObstacleMotion<L::Dim>> for Lbm<L, Q, T> {
    fn view(&self) -> &[Motion<L::Dim>] {
        &self.motions
    }
}

/// A motion holds for the whole of each step from the next one on, until another one is given: that of the middle of the step
/// is right to second order. Giving another velocity or spin at the same place costs no search for links.
impl<L: Lattice<Q>, const Q: usize, T: Real> Accepts<ObstacleMotion<L::Dim>> for Lbm<L, Q, T> {
    fn view_mut(&mut self) -> &mut [Motion<L::Dim>] {
        self.may_have_moved = true;
        &mut self.motions
    }
}

/// What changed of the motion of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    None,
    Velocity,
    Place,
}

/// A cell that a body left.
pub(crate) struct Uncovered<D: Dim> {
    cell: [usize; 3],
    /// Number of the body.
    body: usize,
    /// Velocity of the body there \[m/s\].
    velocity: D::Vec,
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// Takes up the motion lent to the obstacles since the last step.
    pub(crate) fn meet_moved_obstacles(&mut self) -> Result<(), StepError> {
        if !std::mem::take(&mut self.may_have_moved) {
            return Ok(());
        }
        let moved = |k: usize| self.motions[k] != self.setup.obstacles[k].motion();
        if !(0..self.motions.len()).any(moved) {
            return Ok(());
        }
        self.check_motions()?;
        let uncovered = self.place_obstacles(self.motions.clone());
        self.refill(&uncovered);
        self.look_at_open_faces();
        Ok(())
    }

    fn check_motions(&self) -> Result<(), StepError> {
        for (k, (motion, obstacle)) in self.motions.iter().zip(&self.setup.obstacles).enumerate() {
            if !motion.is_finite() {
                let (solver, quantity) = (self.name(), "motion lent to an obstacle");
                return Err(StepError::NotFinite { solver, quantity, id: k as u64, step: self.steps });
            }
            let turning = obstacle.shape.reach() * motion.spin.length();
            let speed = (motion.velocity.length() + turning) / self.setup.lattice_speed();
            if speed > FASTEST {
                return Err(StepError::TooStiff {
                    what: format!(
                        "speed of obstacle `{}` in cells per step after step {}",
                        obstacle.name, self.steps
                    ),
                    value: speed,
                    allowed: FASTEST,
                    hint: "take a smaller step, or a slower motion".to_owned(),
                });
            }
        }
        Ok(())
    }

    /// Puts the obstacles where they are now and finds cells, runs and links again where bodies came from and went. A body that
    /// stays in place and moves on otherwise keeps its links. Returns the cells that bodies left.
    pub(crate) fn place_obstacles(&mut self, motions: Vec<Motion<L::Dim>>) -> Vec<Uncovered<L::Dim>> {
        let domain = Domain::of(&self.setup);
        let mut ranges: Vec<Range> = Vec::new();
        let mut changes = vec![Change::None; motions.len()];
        for (k, motion) in motions.iter().enumerate() {
            let obstacle = &mut self.setup.obstacles[k];
            let before = (obstacle.displacement, obstacle.velocity, obstacle.spin);
            obstacle.set_motion(*motion, &domain);
            if obstacle.displacement != before.0 {
                changes[k] = Change::Place;
                for displacement in [before.0, obstacle.displacement] {
                    obstacle.displacement = displacement;
                    let images = domain.images(obstacle, 0.0);
                    ranges.extend(images.into_iter().map(|image| domain.near(obstacle, image, 0.0)));
                }
            } else if (obstacle.velocity, obstacle.spin) != (before.1, before.2) {
                changes[k] = Change::Velocity;
            }
        }
        self.motions = motions;
        let uncovered = if ranges.is_empty() { Vec::new() } else { self.cover_again(&domain, &ranges) };
        self.immersed.is_stale |= !ranges.is_empty();
        self.link_again(&changes, &ranges, &domain);
        uncovered
    }

    fn cover_again(&mut self, domain: &Domain<L::Dim>, ranges: &[Range]) -> Vec<Uncovered<L::Dim>> {
        let images: Vec<_> = self.setup.obstacles.iter().map(|body| domain.images(body, 0.0)).collect();
        let mut uncovered = Vec::new();
        for cell in ranges.iter().flat_map(|range| cells_of(*range)) {
            let centre = domain.centre(cell.map(|x| x as i64));
            let covers = |(body, images): (&crate::Obstacle<L::Dim>, &Vec<_>)| {
                images.iter().any(|image| body.shape.contains(centre - *image))
            };
            let number =
                self.setup.obstacles.iter().zip(&images).position(covers).map_or(0, |k| k as u16 + 1);
            let before = std::mem::replace(&mut self.cover[cell_index(self.setup.cells, cell)], number);
            match (before, number) {
                (0, 0) => {}
                (0, _) => {
                    self.fluid_cells -= 1;
                    let place = self.populations.grid.place(cell.map(|x| x as i64));
                    self.keep(number as usize - 1, self.moments(place).0);
                }
                (_, 0) => {
                    self.fluid_cells += 1;
                    let number = before as usize - 1;
                    let body = &self.setup.obstacles[number];
                    let arm = centre - domain.nearest_image(body, centre);
                    uncovered.push(Uncovered { cell, body: number, velocity: body.velocity_at(arm) });
                }
                _ => {}
            }
        }
        for range in ranges {
            let cover = &self.cover;
            let is_fluid = |cell| cover[cell_index(domain.cells, cell)] == 0;
            self.runs.refresh(&self.populations.grid, *range, is_fluid);
        }
        uncovered
    }

    fn link_again(&mut self, changes: &[Change], ranges: &[Range], domain: &Domain<L::Dim>) {
        let builder = Builder::<L, Q>::new(&self.setup, &self.populations.grid, &self.cover);
        for (k, change) in changes.iter().enumerate() {
            let cuts = &mut self.beyond.obstacles[k];
            if *change == Change::Place || builder.comes_near(k, ranges) {
                let fresh = builder.cuts_of(k);
                let before = std::mem::replace(cuts, fresh);
                (cuts.force, cuts.torque, cuts.kept) = (before.force, before.torque, before.kept);
            } else if *change == Change::Velocity {
                set_velocity::<L, T, Q>(cuts, &self.setup, k);
            }
        }
        // A wall moves as a body does that touches it.
        let is_at_wall = |(body, change): (&crate::Obstacle<L::Dim>, &Change)| {
            let is_at_face = |image: &_| domain.is_at_face(domain.near(body, *image, 0.0));
            *change == Change::Velocity && domain.images(body, 0.0).iter().any(is_at_face)
        };
        if ranges.iter().any(|range| domain.is_at_face(*range)) {
            self.beyond.copies = builder.copies();
            let seen = self.beyond.open.seen();
            self.beyond.open = open_faces::<L, Q>(&self.setup, &self.populations.grid, &self.cover);
            self.beyond.open.set_seen(&seen);
        } else if self.setup.obstacles.iter().zip(changes).any(is_at_wall) {
            self.beyond.copies = builder.copies();
        }
    }

    fn refill(&mut self, uncovered: &[Uncovered<L::Dim>]) {
        let filled: Vec<[f64; Q]> = uncovered.iter().map(|fresh| self.filling(fresh, uncovered)).collect();
        for (fresh, values) in uncovered.iter().zip(filled) {
            let place = self.populations.grid.place(fresh.cell.map(|x| x as i64));
            self.populations.set_entering::<L, Q>(place, values.map(T::of));
            self.keep(fresh.body, -self.moments(place).0);
        }
    }

    /// Leaves mass \[cells at the density at rest\] with an obstacle.
    fn keep(&mut self, obstacle: usize, mass: f64) {
        let kept = &mut self.beyond.obstacles[obstacle].kept;
        *kept = kept.wrapping_add(counted(mass));
    }

    /// What enters a cell that a body left.
    fn filling(&self, fresh: &Uncovered<L::Dim>, uncovered: &[Uncovered<L::Dim>]) -> [f64; Q] {
        let builder = Builder::<L, Q>::new(&self.setup, &self.populations.grid, &self.cover);
        let cell = fresh.cell.map(|x| x as i64);
        let (mut count, mut excess, mut deviation) = (0.0, 0.0, [0.0; Q]);
        for direction in 1..Q {
            let Some(Seen { cell: beside, mirror }) = builder.seen(cell, direction) else { continue };
            if uncovered.iter().any(|other| other.cell.map(|x| x as i64) == beside) {
                continue;
            }
            let place = self.populations.grid.place(beside);
            let (density, momentum) = self.moments(place);
            let f = self.populations.entering::<L, Q>(place).map(T::double);
            let rest = equilibrium::<L, Q>(density, momentum.map(|j| j / (1.0 + density)));
            count += 1.0;
            excess += density;
            for (i, deviation) in deviation.iter_mut().enumerate() {
                let i = mirrored::<L, Q>(i, mirror);
                *deviation += f[i] - rest[i];
            }
        }
        let share = if count > 0.0 { 1.0 / count } else { 0.0 };
        let velocity = fresh.velocity.padded().map(|c| c / self.setup.lattice_speed());
        let mut f = equilibrium::<L, Q>(excess * share, velocity);
        (0..Q).for_each(|i| f[i] += deviation[i] * share);
        f
    }
}
