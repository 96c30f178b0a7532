//! Free grains in a fluid that is resolved between them.

mod grain;
mod known;
mod options;

pub use options::{HeldLoad, ResolvedOptions};

use grain::Around;
use granular_core::{
    Accepts, Bound, Coupling, CouplingError, Dim, FieldSink, FlowLoad, GrainMotion, HydroLoad, ImmersedGrain,
    ImmersedGrains, Limits, Linear, Provides, Section, Shown, ShownAs, SnapshotError, StepError,
};
use known::Known;
use options::COARSEST;

/// Cells to the hydrodynamic radius from which on forces are right to a few per cent.
const FINE: f64 = 5.0;

/// Grains and the fluid between them move each other.
///
/// Before each step of the fluid every grain is handed to it as [`ImmersedGrain`], where it will be in the middle of that step, with the velocity
/// and spin that it will have then and with its hydrodynamic radius. What the flow did to it is put on the grain, and held over all steps that
/// grains take within one of the fluid. With the load `L` of the flow, the force on a grain is
///
/// ```text
/// F = L + rho_i s V_h (U_n - U_(n-1)) / dt - rho s V g
/// ```
///
/// `rho` is the density of the fluid, `rho_i` that of the fluid which fills the grain and moves with it, `V_h` the volume of the grain at its
/// hydrodynamic radius and `V` at its own, `s` the share of it that lies in the fluid, and `U_n` the velocity with which the fluid met it in step
/// `n`. The second term takes away the inertia of the fluid within the grain; what a grain finds in its place in its first step counts as
/// `U_(n-1)`. The third is buoyancy: the fluid leaves it out whether it has a body force or not. Torques have the second term with the moment of
/// inertia of that fluid.
///
/// The inertia that is taken away is that of the step before, so that what the grain itself has need not be more than that of the fluid which it
/// displaces. Momentum of fluid and grains, `sum rho u h^N + sum (m U - rho_i V_h U_n)`, is kept to round-off but for the weights, at all times with
/// [`HeldLoad::OneStep`] and but for half of the last load with [`HeldLoad::TwoSteps`].
///
/// Grains may come and go, be re-sorted, cross periodic faces and leave the fluid. The law needs no lubrication: what flows through gaps of less than
/// a cell is not resolved.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedGrains<D: Dim> {
    options: ResolvedOptions<D>,
    /// Step of the fluid \[s\].
    dt: f64,
    /// Grains as they were handed to the fluid, in that order.
    known: Known<D>,
    /// Where they begin in the list of the fluid.
    first: usize,
    /// Whether the fluid has taken a step since.
    is_due: bool,
}

impl<D: Dim> ResolvedGrains<D> {
    /// All grains of a solver.
    pub fn new(options: ResolvedOptions<D>) -> Self {
        Self { options, dt: 0.0, known: Known::default(), first: 0, is_due: false }
    }

    /// What was chosen.
    pub fn options(&self) -> &ResolvedOptions<D> {
        &self.options
    }

    /// Finds what the fluid did to each grain in its step.
    fn take_loads(&mut self, fluid: &impl Provides<FlowLoad<D>>) -> Result<(), StepError> {
        let flow = fluid.view();
        let gravity = self.options.gravity.unwrap_or(flow.gravity);
        let around = Around { flow, dt: self.dt, gravity, held: self.options.held };
        for (k, grain) in self.known.grains.iter_mut().enumerate() {
            let at = self.first + k;
            grain.take(&flow.loads[at], &flow.covered[at], &around);
            if !grain.load.is_finite() {
                let (solver, quantity) = ("resolved grains", "load of the fluid");
                return Err(StepError::NotFinite { solver, quantity, id: u64::from(grain.id), step: 0 });
            }
        }
        Ok(())
    }

    /// The coarsest grain: its identifier, and the edge of a cell over its hydrodynamic radius.
    fn coarsest(&self, grains: &impl Provides<GrainMotion<D>>, spacing: f64) -> Option<(u32, f64)> {
        let coarseness = |(id, _, radius): (u32, _, f64)| (id, spacing / (self.options.factor(id) * radius));
        grains.view().iter().map(coarseness).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn check_sizes(&self, grains: &impl Provides<GrainMotion<D>>, spacing: f64) -> Result<(), StepError> {
        match self.coarsest(grains, spacing) {
            Some((id, value)) if value > COARSEST => Err(StepError::TooStiff {
                what: format!("edge of a cell of the fluid over the hydrodynamic radius of grain {id}"),
                value,
                allowed: COARSEST,
                hint: "take smaller cells, or larger grains".to_owned(),
            }),
            _ => Ok(()),
        }
    }
}

impl<D: Dim, Slow, Fast> Coupling<Slow, Fast> for ResolvedGrains<D>
where
    Slow: Accepts<ImmersedGrains<D>> + Provides<FlowLoad<D>>,
    Fast: Provides<GrainMotion<D>> + Accepts<HydroLoad<D>>,
{
    fn name(&self) -> &'static str {
        "resolved grains"
    }

    fn attach(&mut self, slow: &mut Slow, fast: &mut Fast) -> Result<(), CouplingError> {
        let refuse = |reason: String| CouplingError::new("resolved grains", reason);
        self.options.check().map_err(|error| refuse(error.to_string()))?;
        let spacing = Provides::<FlowLoad<D>>::view(slow).spacing;
        self.check_sizes(fast, spacing).map_err(|error| refuse(error.to_string()))?;
        Accepts::<ImmersedGrains<D>>::enable(slow);
        Accepts::<HydroLoad<D>>::enable(fast);
        self.known.follow(Provides::<GrainMotion<D>>::view(fast));
        Ok(())
    }

    fn begin(&mut self, long_step: f64) {
        self.dt = long_step;
    }

    fn forward(&mut self, fast: &Fast, slow: &mut Slow) -> Result<(), StepError> {
        let grains = fast.view();
        if self.known.follow(grains) {
            self.check_sizes(fast, Provides::<FlowLoad<D>>::view(slow).spacing)?;
        }
        let list = slow.view_mut();
        self.first = list.len();
        for (grain, (id, motion, radius)) in self.known.grains.iter_mut().zip(grains.iter()) {
            grain.radius = [radius, self.options.factor(id) * radius];
            list.push(ImmersedGrain { motion: grain.meet(motion, self.dt), radius: grain.radius[1] });
        }
        self.is_due = true;
        Ok(())
    }

    fn backward(&mut self, slow: &Slow, fast: &mut Fast) -> Result<(), StepError> {
        if std::mem::take(&mut self.is_due) {
            self.take_loads(slow)?;
        }
        let mut loads = fast.view_mut();
        for (k, (id, load)) in loads.iter_mut().enumerate() {
            // A grain that has come since the fluid took its step has no load.
            if let Some(grain) = self.known.find(k, id) {
                *load += grain.load;
            }
        }
        Ok(())
    }

    fn limits(&self, slow: &Slow, fast: &Fast, report: &mut Limits) {
        let Some((id, value)) = self.coarsest(fast, Provides::<FlowLoad<D>>::view(slow).spacing) else {
            return;
        };
        let why = format!(
            "the hydrodynamic radius of grain {id} is {:.3} cells of the fluid, below which forces are off by more than a few per \
             cent; take smaller cells",
            1.0 / value
        );
        let name = "cell of the fluid over the radius of a grain";
        report.bounds.push(Bound { name, value, allowed: 1.0 / FINE, unit: "-", refuses: false, why });
    }

    fn shown(&self) -> Vec<Shown> {
        let meaning = "force of the fluid on a grain, with buoyancy";
        vec![Shown::new("fluid_force", "N", meaning, ShownAs::Field)]
    }

    fn show(&self, _: &Slow, fast: &Fast, sink: &mut dyn FieldSink) {
        if !sink.wants("fluid_force") {
            return;
        }
        let grains = fast.view();
        let force =
            |k: usize| self.known.find(k, grains.id(k)).map_or(D::Vec::ZERO, |grain| grain.load.force);
        let forces: Vec<D::Vec> = (0..grains.len()).map(force).collect();
        sink.field("fluid_force", "N", D::vector_field(&forces));
    }

    fn save(&self, to: &mut Section) {
        self.known.save(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.known = Known::restored(from)?;
        self.is_due = false;
        Ok(())
    }
}
