//! The contract of every solver: limits, memory, state.

use crate::lattice::Lattice;
use crate::lbm::Lbm;
use crate::open::OpenScheme;
use crate::real::Real;
use crate::setup::{Face, Setup};
use crate::{OddRate, Operator, show};
use granular_core::{
    Bound, Dim, FieldSink, Limits, Linear, Location, Memory, Motion, Section, Shown, SnapshotError, Solver,
    StepError, StepLimit, Vector,
};

/// Largest Mach number; errors of compressibility grow with its square.
const MACH: f64 = 0.3;
/// Largest constant of the closure below which it counts as none.
const CLOSURE: f64 = 0.1;

/// Largest grid Reynolds numbers, of the flow (`u h / nu`) and of sound (`c_s h / nu`).
pub(crate) type Borne = [f64; 2];
/// No limit was found on sound.
const ANY: f64 = f64::INFINITY;

/// What flows that start at full speed bear, for each operator: between walls or periodic, with Zou-He faces, with
/// regularised faces; each without and with a closure of constant 0.1.
///
/// Set from what `granular validate stability lbm` measured in the plane on shear layers, cavities and jets of 24 and 32
/// cells up to Mach 0.3, with a margin (docs/lbm-studies.md): fitted to these flows, not derived, and 1000 is the largest
/// tried. Two relaxation times were run with `Lambda` 3/16, multiple ones with the rates of [`Operator::EXACT_WALLS`] and
/// [`Operator::KUMAR`]; others may bear less.
const BORNE: [[Borne; 6]; 5] = [
    // One relaxation time.
    [[12.0, ANY], [22.0, ANY], [10.0, 25.0], [22.0, 55.0], [12.0, 100.0], [22.0, 190.0]],
    // Two.
    [[25.0, ANY], [60.0, ANY], [11.0, ANY], [13.0, ANY], [11.0, ANY], [19.0, ANY]],
    // Multiple, odd rate by `Lambda`.
    [[9.0, ANY], [80.0, ANY], [9.0, ANY], [80.0, ANY], [9.0, ANY], [10.0, ANY]],
    // Multiple, odd rate given.
    [[50.0, ANY], [1000.0, ANY], [50.0, 50.0], [1000.0, 3000.0], [50.0, 140.0], [1000.0, ANY]],
    // Regularised.
    [[80.0, ANY], [1000.0, ANY], [80.0, 140.0], [800.0, ANY], [80.0, 140.0], [800.0, ANY]],
];

/// What a flow bears with an operator; see [`BORNE`].
pub(crate) fn borne<D: Dim>(setup: &Setup<D>, operator: Operator) -> Borne {
    let row = match operator {
        Operator::SingleRelaxation => 0,
        Operator::TwoRelaxation { .. } => 1,
        Operator::MultipleRelaxation { odd: OddRate::Magic(_), .. } => 2,
        Operator::MultipleRelaxation { odd: OddRate::Rate(_), .. } => 3,
        Operator::Regularised => 4,
    };
    let is_closed = usize::from(setup.smagorinsky.is_some_and(|constant| constant >= CLOSURE));
    let schemes = setup.faces.iter().flatten().filter_map(Face::scheme);
    // Each scheme has limits of its own: the lowest binds.
    let columns = schemes.map(|scheme| match scheme {
        OpenScheme::ZouHe => 2,
        OpenScheme::Regularised => 4,
    });
    std::iter::once(0).chain(columns).fold([ANY; 2], |[flow, sound], column| {
        let [other_flow, other_sound] = BORNE[row][column + is_closed];
        [flow.min(other_flow), sound.min(other_sound)]
    })
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// Largest speed that faces, obstacles and the setup name \[m/s\].
    pub fn largest_expected_speed(&self) -> f64 {
        let setup = &self.setup;
        let entering = self
            .beyond
            .open
            .given_velocities()
            .map(|velocity| velocity.iter().map(|c| c * c).sum::<f64>().sqrt() * setup.lattice_speed());
        let bodies = setup
            .obstacles
            .iter()
            .map(|body| body.velocity.length() + body.spin.length() * body.shape.reach());
        let bodies = bodies.chain([self.immersed.fastest()]);
        entering.chain(bodies).fold(setup.expected_speed.max(setup.fastest_wall()), f64::max)
    }

    fn report_limits(&self, report: &mut Limits) {
        let setup = &self.setup;
        let Setup { spacing, viscosity, time_step, .. } = *setup;
        let (tau, speed) = (setup.tau(), self.largest_expected_speed());
        report.steps.push(StepLimit::exactly(
            "lattice",
            time_step,
            format!(
                "relaxation time {tau:.5} steps, {:.4} m/s per cell and step, Lambda {:.4}",
                setup.lattice_speed(),
                setup.operator.magic(tau)
            ),
        ));
        // A flow that a body force drives says nothing of its speed beforehand.
        let known = |why: String| {
            if speed > 0.0 {
                why
            } else {
                "no face or obstacle names a speed: set the one expected".to_owned()
            }
        };
        let sound = setup.lattice_speed() / 3.0_f64.sqrt();
        let longest = MACH * spacing / (3.0_f64.sqrt() * speed);
        report.bounds.push(Bound {
            name: "Mach number",
            value: speed / sound,
            allowed: MACH,
            unit: "",
            refuses: true,
            why: known(format!(
                "largest speed {speed:.4} m/s over that of sound on the lattice; a step of at most {longest:.3e} s keeps \
                 it, and the error falls with the square of the step"
            )),
        });
        let [allowed, of_sound] = borne(setup, setup.operator);
        report.bounds.push(Bound {
            name: "grid Reynolds number",
            value: speed * spacing / viscosity,
            allowed,
            unit: "",
            refuses: false,
            why: known(format!(
                "largest speed times cell over viscosity; cells of {:.3e} m keep it; a closure or another operator \
                 allows more",
                allowed * viscosity / speed
            )),
        });
        if of_sound.is_finite() {
            report.bounds.push(Bound {
                name: "grid Reynolds number of sound",
                value: sound * spacing / viscosity,
                allowed: of_sound,
                unit: "",
                refuses: false,
                why: format!(
                    "speed of sound times cell over viscosity; open faces excite what too little viscosity does not damp: a \
                     relaxation time of {:.4} steps keeps it; a closure or another operator allows more",
                    0.5 + 3.0_f64.sqrt() / of_sound
                ),
            });
        }
        report.advice.extend(setup.advice(speed));
    }

    fn memory_in_use(&self) -> Memory {
        let populations = self.populations.values.len() * size_of::<T>();
        let links = self.beyond.copies.bytes()
            + self.row_links.bytes()
            + self.beyond.obstacles.iter().map(|cuts| cuts.bytes()).sum::<usize>()
            + self.beyond.open.bytes();
        let bytes = populations
            + links
            + self.field.bytes()
            + self.runs.bytes()
            + self.immersed.bytes()
            + 2 * self.cover.capacity();
        let mut left_out = Vec::new();
        let mut note = |is_off: bool, text: &str| {
            if is_off {
                left_out.push(text.to_owned());
            }
        };
        note(!self.physics.has_force(), "body force: none is set");
        note(!self.physics.has_closure(), "eddy viscosity: no Smagorinsky constant is set");
        note(!self.physics.has_ghosts(), "rates of energy moments: the operator has none");
        note(self.cover.is_empty(), "cells covered by obstacles: there are none");
        note(!self.immersed.is_on, "cells covered by grains: no law puts grains into the fluid");
        note(self.beyond.open.is_empty(), "open faces: there are none");
        left_out.push("density and velocity: computed from populations when an output asks".to_owned());
        Memory { bytes, bytes_per_item: bytes / self.setup.cells.iter().product::<usize>().max(1), left_out }
    }
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    fn saved_motions(&self, from: &Section) -> Result<Vec<Motion<L::Dim>>, SnapshotError> {
        let count = self.setup.obstacles.len();
        let positions: Vec<<L::Dim as Dim>::Vec> = from.array_of("positions of obstacles", count)?;
        let velocities: Vec<<L::Dim as Dim>::Vec> = from.array_of("velocities of obstacles", count)?;
        let spins: Vec<<L::Dim as Dim>::Spin> = from.array_of("spins of obstacles", count)?;
        let motions = positions.into_iter().zip(velocities).zip(spins);
        let motions = motions.map(|((position, velocity), spin)| Motion::new(position, velocity, spin));
        let motions: Vec<_> = motions.collect();
        if motions.iter().all(Motion::is_finite) {
            return Ok(motions);
        }
        let found = "a number that is not finite".to_owned();
        Err(SnapshotError::Damaged { place: "solver/positions of obstacles".to_owned(), found })
    }
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Solver for Lbm<L, Q, T> {
    fn name(&self) -> &'static str {
        "lattice Boltzmann"
    }

    fn size(&self) -> (usize, &'static str) {
        (self.setup.cells.iter().product(), "cell")
    }

    fn limits(&self, report: &mut Limits) {
        self.report_limits(report);
    }

    fn hard_limits_may_change(&self) -> bool {
        false
    }

    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        self.populations.slabs(&self.runs).inside_pool(|| self.advance_by(dt, steps))
    }

    fn clear_inputs(&mut self) {
        self.immersed.given.clear();
    }

    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        let mut origin = self.setup.origin.padded();
        let spacing = self.setup.spacing;
        // One layer of cells about z = 0 in the plane.
        if L::Dim::N == 2 {
            origin[2] = -0.5 * spacing;
        }
        vec![("cells", Location::Grid { origin, spacing: [spacing; 3], cells: self.setup.cells })]
    }

    fn shown(&self) -> Vec<Shown> {
        show::shown(self)
    }

    fn show(&self, sink: &mut dyn FieldSink) {
        show::show(self, sink);
    }

    fn save(&self, to: &mut Section) {
        to.put_text("lattice", L::NAME);
        to.put_one("steps", self.steps);
        to.put_one("acceleration", self.setup.acceleration);
        // What enters each cell, whatever the layout: the same bytes at odd and even steps.
        to.put_each("populations", self.fluid_cells * Q, |put| {
            for (_, place) in self.fluid() {
                self.populations.entering::<L, Q>(place).into_iter().for_each(&mut *put);
            }
        });
        let loads: Vec<[f64; 6]> = self
            .beyond
            .obstacles
            .iter()
            .map(|body| {
                let ([a, b, c], [d, e, f]) = (body.force, body.torque);
                [a, b, c, d, e, f]
            })
            .collect();
        to.put("force and torque on obstacles", &loads);
        let kept: Vec<u64> = self.beyond.obstacles.iter().map(|body| body.kept as u64).collect();
        to.put("mass kept by obstacles", &kept);
        let motions = || self.setup.obstacles.iter().map(|obstacle| obstacle.motion());
        to.put("positions of obstacles", &motions().map(|motion| motion.position).collect::<Vec<_>>());
        to.put("velocities of obstacles", &motions().map(|motion| motion.velocity).collect::<Vec<_>>());
        to.put("spins of obstacles", &motions().map(|motion| motion.spin).collect::<Vec<_>>());
        let seen = self.beyond.open.seen();
        if !seen.is_empty() {
            to.put("what absorbing faces saw", &seen);
        }
        self.save_immersed(to);
        self.save_faces(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let lattice = from.text("lattice")?;
        if lattice != L::NAME {
            let found = format!("{lattice} where {} is expected", L::NAME);
            return Err(SnapshotError::Damaged { place: "solver/lattice".to_owned(), found });
        }
        let steps = from.one("steps")?;
        let acceleration: <L::Dim as Dim>::Vec = from.one("acceleration")?;
        let motions = self.saved_motions(from)?;
        self.restore_faces(from)?;
        self.place_obstacles(motions);
        self.restore_immersed(from)?;
        let populations: Vec<T> = from.array_of("populations", self.fluid_cells * Q)?;
        let loads: Vec<[f64; 6]> =
            from.array_of("force and torque on obstacles", self.beyond.obstacles.len())?;
        let absorbing = self.beyond.open.seen().len();
        let seen: Vec<[f64; 2]> =
            if absorbing > 0 { from.array_of("what absorbing faces saw", absorbing)? } else { Vec::new() };
        let kept: Vec<u64> = from.array_of("mass kept by obstacles", self.beyond.obstacles.len())?;
        let are_finite = [
            ("what absorbing faces saw", seen.iter().flatten().all(|c| c.is_finite())),
            ("acceleration", acceleration.is_finite()),
            ("force and torque on obstacles", loads.iter().flatten().all(|c| c.is_finite())),
        ];
        if let Some((name, _)) = are_finite.into_iter().find(|(_, is_finite)| !is_finite) {
            let found = "a number that is not finite".to_owned();
            return Err(SnapshotError::Damaged { place: format!("solver/{name}"), found });
        }
        self.steps = steps;
        self.set_acceleration(acceleration).expect("it is finite");
        self.follow_body_force();
        let places: Vec<usize> = self.fluid().map(|(_, place)| place).collect();
        for (place, values) in places.into_iter().zip(populations.chunks_exact(Q)) {
            let values = std::array::from_fn(|i| values[i]);
            self.populations.set_entering::<L, Q>(place, values);
        }
        for ((body, [a, b, c, d, e, f]), kept) in self.beyond.obstacles.iter_mut().zip(loads).zip(kept) {
            (body.force, body.torque, body.kept) = ([a, b, c], [d, e, f], kept as i64);
        }
        self.beyond.open.set_seen(&seen);
        Ok(())
    }

    fn memory(&self) -> Memory {
        self.memory_in_use()
    }
}
