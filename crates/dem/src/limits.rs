//! What bounds the step, and what the scene costs in memory.

mod stiffest;

use crate::contact::{Contact, Partner};
use crate::dem::Dem;
use crate::material::{PairProperties, Tension};
use crate::setup::{ContactModel, LeverArm};
use crate::softness::{HERTZ, LINEAR, rounded_up, softer_than};
use granular_core::Shape;
use granular_core::{Bound, Dim, Limits, Linear, Memory, Solver, StepLimit, Vector};
use stiffest::{Oscillator, Stiffest};

/// Overlap over radius above which an impact is called too soft.
const SOFT: f64 = 0.05;

/// Share of the Rayleigh time that the step of Hertz contacts should not exceed \[Li2005\].
const RAYLEIGH_SHARE: f64 = 0.2;

impl<D: Dim> Dem<D> {
    /// The recommended step \[s\]: a fraction of the shortest contact time, and within the
    /// stability limit.
    pub fn recommended_step(&self) -> f64 {
        let mut limits = Limits::default();
        self.report_limits(&mut limits);
        limits.recommended().map_or(1e-3, |limit| limit.dt)
    }

    /// Largest stable step \[s\], from [`stability_step`] of every pair of materials.
    pub fn stable_step(&self) -> f64 {
        let mut limits = Limits::default();
        self.report_limits(&mut limits);
        limits.largest_allowed().map_or(f64::INFINITY, |limit| limit.dt)
    }

    /// Largest step \[s\] at which a contact of its own is stable: beyond, every contact that lasts gains energy in each step,
    /// and [`advance`](Solver::advance) refuses. A packing bears less, see [`Dem::stable_step`].
    pub fn contact_step(&self) -> f64 {
        self.limit_of_a_contact().0
    }

    /// [`Dem::contact_step`], and between which bodies that is; infinite where there are no two that could touch.
    pub(crate) fn limit_of_a_contact(&self) -> (f64, String) {
        let turns = self.pairs.tangential().then(|| self.grains.lightest_to_turn());
        let alone = self.len() < 2 && !self.brings_grains() && self.cell.is_none();
        let pairs = self.stiffest_pairs(false).into_iter().filter(|pair| pair.on_wall || !alone);
        let limits = pairs.map(|pair| (pair.oscillator.largest_step(1, turns), pair.names));
        limits.reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap_or((f64::INFINITY, String::new()))
    }

    pub(crate) fn report_limits(&self, report: &mut Limits) {
        let stiffest = self.stiffest_pairs(true);
        if stiffest.is_empty() {
            return;
        }
        self.report_accuracy(&stiffest, report);
        self.report_stability(&stiffest, report);
        report.bounds.push(self.softness(&stiffest));
        report.bounds.push(Bound {
            name: "overlap at the start",
            value: 100.0 * self.deepest_overlap(),
            allowed: 100.0 * SOFT,
            unit: "% of the radius",
            refuses: true,
            why: self.deepest_named(),
        });
    }

    /// What must not be exceeded, as it stands now.
    pub(crate) fn report_hard_limits(&self, report: &mut Limits) {
        self.report_stability(&self.stiffest_pairs(false), report);
    }

    /// Whether stability depends on speeds, or on the number of grains.
    pub(crate) fn stability_depends_on_the_state(&self) -> bool {
        self.options.contact == ContactModel::Hertz
            || self.moving_walls.servos().next().is_some()
            || self.inlets.inlets().next().is_some()
    }

    /// Steps that resolve a contact.
    fn report_accuracy(&self, stiffest: &[Stiffest], report: &mut Limits) {
        let by =
            |value: fn(&Stiffest) -> f64| stiffest.iter().min_by(move |a, b| value(a).total_cmp(&value(b)));
        let Some(shortest) = by(|pair| pair.contact_time) else { return };
        let fraction = self.options.steps_per_contact;
        report.steps.push(StepLimit::recommended(
            "contact time",
            shortest.contact_time / fraction,
            format!(
                "1/{fraction} of the shortest contact time, {:.4e} s ({}, {})",
                shortest.contact_time, shortest.names, shortest.assumed
            ),
        ));
        if let Some(first) = by(|pair| pair.rayleigh_time).filter(|pair| pair.rayleigh_time.is_finite()) {
            report.steps.push(StepLimit::recommended(
                "Rayleigh time",
                RAYLEIGH_SHARE * first.rayleigh_time,
                format!("{RAYLEIGH_SHARE} of {:.4e} s, lightest grains", first.rayleigh_time),
            ));
        }
    }

    /// Steps beyond which the scheme is unstable.
    fn report_stability(&self, stiffest: &[Stiffest], report: &mut Limits) {
        let neighbours = self.most_neighbours();
        let turns = self.pairs.tangential().then(|| self.grains.lightest_to_turn());
        let step = |pair: &Stiffest| pair.oscillator.largest_step(neighbours, turns);
        let Some(tightest) = stiffest.iter().min_by(|a, b| step(a).total_cmp(&step(b))) else { return };
        report.steps.push(StepLimit::at_most(
            "stability",
            step(tightest),
            format!(
                "leapfrog with damping, {neighbours} contacts per grain, {}, {}",
                tightest.names, tightest.assumed
            ),
        ));
        report.steps.extend(self.servo_limits(stiffest));
    }

    /// Contacts that one of the smallest grains can have at once.
    fn most_neighbours(&self) -> usize {
        let kissing = if D::N == 2 { 6 } else { 12 };
        if self.cell.is_some() {
            return kissing;
        }
        let surfaces: usize = self
            .walls
            .iter()
            .map(|wall| match &wall.shape {
                Shape::Facets(facets) => facets.len(),
                _ => 1,
            })
            .sum();
        kissing.min((self.len().saturating_sub(1) + surfaces).max(1))
    }

    /// A wall under a force swings on the springs of the grains at it, of which a layer across the sample has
    /// about `2 n^((d - 1) / d)`.
    fn servo_limits(&self, pairs: &[Stiffest]) -> Option<StepLimit> {
        let layer = 2.0 * (self.len() as f64).powf(1.0 - 1.0 / D::N as f64);
        let grains = layer.min(self.len() as f64).max(1.0);
        let stiffness = pairs.iter().map(|pair| pair.stiffness).fold(0.0, f64::max);
        let (wall, servo) = self.moving_walls.servos().min_by(|a, b| a.1.mass.total_cmp(&b.1.mass))?;
        Some(StepLimit::at_most(
            "wall under a force",
            2.0 * (servo.mass / (grains * stiffness)).sqrt(),
            format!(
                "`{}` of {:.3e} kg on the springs of {grains:.0} grains",
                self.walls[wall].name, servo.mass
            ),
        ))
    }

    /// Overlap of an impact at the fastest speed there can be: present speeds, and a fall
    /// through the height of the sample.
    fn softness(&self, pairs: &[Stiffest]) -> Bound {
        let smallest = self.smallest_radius();
        let hardest = pairs.iter().max_by(|a, b| a.deepest.total_cmp(&b.deepest));
        let (deepest, fastest) = hardest.map_or((0.0, 0.0), |pair| (pair.deepest, pair.speed));
        Bound {
            name: "overlap of the hardest impact",
            value: 100.0 * deepest / smallest,
            allowed: 100.0 * crate::view::DEEPEST,
            unit: "% of the radius",
            refuses: true,
            why: format!(
                "two grains that meet at {fastest:.3} m/s{}",
                self.stiffer(hardest, deepest / smallest)
            ),
        }
    }

    /// How stiff the contacts of a pair must be for an allowed overlap, when that of its hardest impact over the radius is
    /// too large.
    fn stiffer(&self, pair: Option<&Stiffest>, overlap: f64) -> String {
        let too_much = overlap / crate::view::DEEPEST;
        let Some(pair) = pair.filter(|_| too_much > 1.0) else { return String::new() };
        match self.options.contact {
            ContactModel::Linear => {
                let factor = softer_than(too_much, LINEAR);
                let target = rounded_up(factor * pair.stiffness);
                format!("; raise the normal stiffness {factor}-fold, to {target:e} N/m for {}", pair.names)
            }
            ContactModel::Hertz => {
                format!("; raise Young's modulus {}-fold for {}", softer_than(too_much, HERTZ), pair.names)
            }
        }
    }

    /// The fastest present speed, and that of a fall through the height of the sample \[m/s\].
    pub(crate) fn fastest_speeds(&self) -> (f64, f64) {
        let speed = self.blocks.largest(|i| self.grains.velocity[i].length()).max(0.0);
        let gravity = self.gravity.length();
        let fall = if gravity > 0.0 { (2.0 * gravity * self.extent_along_gravity()).sqrt() } else { 0.0 };
        let coming = self.inlets.inlets().map(|inlet| inlet.velocity.length()).fold(0.0, f64::max);
        (speed.max(coming) + self.moving_walls.fastest_ever(), fall)
    }

    /// Radius of the smallest grain that there is or may come in \[m\].
    pub(crate) fn smallest_radius(&self) -> f64 {
        let of_inlets = self.inlets.inlets().flat_map(|inlet| inlet.radii.iter().copied());
        of_inlets.fold(self.grains.radius_range().0, f64::min)
    }

    /// Height of the sample \[m\]; zero without gravity.
    pub(crate) fn extent_along_gravity(&self) -> f64 {
        let gravity = self.gravity.length();
        if gravity == 0.0 {
            return 0.0;
        }
        let direction = self.gravity * (1.0 / gravity);
        let highest = self.blocks.largest(|i| -self.grains.position[i].dot(direction));
        let deepest = self.blocks.largest(|i| self.grains.position[i].dot(direction));
        // Grains that come in fall as far as those that are there.
        let corners = self.inlets.inlets().flat_map(|inlet| [inlet.low, inlet.high]);
        let heights = corners.map(|corner| -corner.dot(direction));
        let (highest, lowest) =
            heights.fold((highest, -deepest), |(high, low), height| (high.max(height), low.min(height)));
        (highest - lowest).max(0.0)
    }

    /// Largest overlap over the radius of the smaller grain.
    pub fn deepest_overlap(&self) -> f64 {
        self.deepest_contact().map_or(0.0, |(share, _)| share.max(0.0))
    }

    /// The contact whose overlap over the radius of the smaller grain is largest, and that share.
    fn deepest_contact(&self) -> Option<(f64, Contact<D>)> {
        let mut deepest: Option<(f64, Contact<D>)> = None;
        self.visit_contacts(&mut |contact| {
            let own = self.grains.radius[contact.first];
            let smaller = match contact.partner {
                Partner::Grain(second) => own.min(self.grains.radius[second]),
                Partner::Wall(_) => own,
            };
            let share = contact.overlap / smaller;
            if deepest.as_ref().is_none_or(|(most, _)| share > *most) {
                deepest = Some((share, contact));
            }
        });
        deepest
    }

    /// Which bodies overlap most, where they are, and by how much.
    fn deepest_named(&self) -> String {
        let Some((share, contact)) = self.deepest_contact() else { return "nothing overlaps".to_owned() };
        if share <= SOFT {
            return "the deepest of all contacts".to_owned();
        }
        let grain = |index: usize| {
            let place: Vec<String> =
                (0..D::N).map(|axis| format!("{:.6}", self.grains.position[index].component(axis))).collect();
            format!("grain {} at ({}) m", self.grains.id[index], place.join(", "))
        };
        let ids = &self.grains.id;
        let (first, second) = match contact.partner {
            // Their order in memory means nothing to who placed them.
            Partner::Grain(second) if ids[second] < ids[contact.first] => {
                (grain(second), grain(contact.first))
            }
            Partner::Grain(second) => (grain(contact.first), grain(second)),
            Partner::Wall(wall) => (grain(contact.first), format!("wall `{}`", self.walls[wall].name)),
        };
        let overlap = contact.overlap;
        format!(
            "{first} and {second} overlap by {overlap:.3e} m and would fly apart; place them apart; grains count from 0"
        )
    }

    pub(crate) fn report_memory(&self) -> Memory {
        let (lists, per_contact) = self.pairs.bytes();
        let per_grain = self.grains.bytes_per_grain();
        let mut left_out = Vec::new();
        if !self.turns() {
            left_out.push("rotation: nothing couples to it without friction".to_owned());
        }
        if per_contact == 0 {
            left_out.push("contact history: the law remembers nothing".to_owned());
        }
        if self.grains.material.is_empty() {
            left_out.push("material per grain: there is one".to_owned());
        }
        if !self.options.ledger {
            left_out.push("energy ledger: no output asks for losses".to_owned());
        }
        if !D::TWISTS && self.materials.iter().any(|material| material.twisting_friction > 0.0) {
            left_out.push("twisting resistance: disks cannot twist".to_owned());
        }
        if D::N == 2 {
            left_out.push("third axis: the scene is plane".to_owned());
        }
        let listed = if self.is_empty() { 0 } else { lists / self.len() };
        Memory { bytes: self.len() * per_grain + lists, bytes_per_item: per_grain + listed, left_out }
    }

    /// A one-line description of method and law, for reports.
    pub fn description(&self) -> String {
        let arm =
            if self.options.lever_arm == LeverArm::Exact { "exact lever arms" } else { "arms of one radius" };
        let tension = if self.options.tension == Tension::Cut { "tension cut" } else { "tension kept" };
        format!("{} {}s, {}, {tension}, {arm}", self.size().0, D::BALL, self.pairs.law_name())
    }
}

/// Largest stable step of the scheme for a grain with `neighbours` equal contacts.
///
/// For one oscillator of frequency `w` and damping ratio `zeta`, the leapfrog with the predicted
/// velocity is stable while `w^2 dt^2 + 8 zeta w dt <= 4`, that is `w dt <= 2 (sqrt(1 + 4
/// zeta^2) - 2 zeta)` (the root -1 of its characteristic polynomial; checked by tests from both
/// sides). A grain in a packing answers at most as fast as if each contact had its share
/// `1/neighbours` of the masses, `w^2 = neighbours * w_pair^2`; a tangential spring adds the
/// rotation, `w_t^2 = (1 + 1/q) k_t / m_eff` with `q` the inertia factor.
pub fn stability_step<D: Dim>(
    pair: &PairProperties,
    effective_mass: f64,
    tension: Tension,
    neighbours: usize,
    turns: bool,
) -> f64 {
    Oscillator::linear(pair, effective_mass, pair.zeta(tension))
        .largest_step(neighbours, turns.then_some(1.0 / D::BALL_INERTIA))
}
