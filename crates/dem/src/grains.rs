//! The grains: one array per property, those that the scene does not need left empty.

use crate::material::{MaterialId, Materials, SetupError};
use granular_core::quantity::Load;
use granular_core::search::curve_order;
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Linear, Section, SnapshotError};

/// Largest over smallest radius.
const LARGEST_RATIO: f64 = 1e6;

/// One grain, as it is put into a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain<D: Dim> {
    /// Centre \[m\].
    pub position: D::Vec,
    /// Velocity \[m/s\].
    pub velocity: D::Vec,
    /// Angular velocity \[rad/s\].
    pub spin: D::Spin,
    /// Radius \[m\].
    pub radius: f64,
    /// Material.
    pub material: MaterialId,
}

impl<D: Dim> Grain<D> {
    /// A grain at rest.
    pub fn at(position: D::Vec, radius: f64, material: MaterialId) -> Self {
        Self { position, velocity: D::Vec::ZERO, spin: D::Spin::ZERO, radius, material }
    }

    /// The same grain with a velocity \[m/s\].
    pub fn moving(self, velocity: D::Vec) -> Self {
        Self { velocity, ..self }
    }

    /// The same grain with an angular velocity \[rad/s\].
    pub fn turning(self, spin: D::Spin) -> Self {
        Self { spin, ..self }
    }
}

/// State and scratch of all grains. Grains are re-sorted in memory; `id` is stable.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grains<D: Dim> {
    pub(crate) position: Vec<D::Vec>,
    pub(crate) velocity: Vec<D::Vec>,
    /// Acceleration of the last step; holds the contact force while a step is under way.
    pub(crate) acceleration: Vec<D::Vec>,
    pub(crate) radius: Vec<f64>,
    pub(crate) mass: Vec<f64>,
    pub(crate) id: Vec<u32>,
    /// Empty when all grains are of one material.
    pub(crate) material: Vec<u8>,
    /// Whether there are several materials; with no grains the array does not tell.
    several_materials: bool,
    pub(crate) first_material: u8,
    /// Whether grains turn; with no grains the arrays do not tell.
    pub(crate) turns: bool,
    /// Moments of inertia where some are given \[kg m^2\]; empty where all are those of uniform balls.
    pub(crate) inertia: Vec<f64>,
    /// Grains that are held in their place; empty when none is.
    pub(crate) fixed: Vec<bool>,
    /// Masses as contacts see them, those of fixed grains without end; empty when none is fixed.
    contact_mass: Vec<f64>,
    /// Whether others put loads on grains.
    pub(crate) takes_loads: bool,
    /// Loads that others put on grains, such as those of a fluid; empty unless one does.
    pub(crate) load: Vec<Load<D>>,
    /// Empty when nothing makes grains turn; so are the two arrays of spins below.
    pub(crate) spin: Vec<D::Spin>,
    pub(crate) spin_acceleration: Vec<D::Spin>,
    /// Scratch: velocity and spin at the middle of the step.
    pub(crate) middle_velocity: Vec<D::Vec>,
    pub(crate) middle_spin: Vec<D::Spin>,
}

impl<D: Dim> Grains<D> {
    pub(crate) fn new(list: &[Grain<D>], materials: &Materials, gravity: D::Vec) -> Result<Self, SetupError> {
        if u32::try_from(list.len()).is_err() {
            return Err(SetupError::new("number of grains", list.len() as f64, "below 2^32"));
        }
        // Of sizes that do not fit together both are told, before one of them is refused by itself.
        check_sizes(list.iter().map(|grain| grain.radius).filter(|radius| *radius > 0.0))?;
        for grain in list {
            check(grain, materials)?;
        }
        let first_material = list.first().map_or(0, |grain| grain.material.0);
        let uniform = list.iter().all(|grain| grain.material.0 == first_material);
        Ok(Self {
            position: list.iter().map(|grain| grain.position).collect(),
            velocity: list.iter().map(|grain| grain.velocity).collect(),
            acceleration: vec![gravity; list.len()],
            radius: list.iter().map(|grain| grain.radius).collect(),
            mass: list.iter().map(|grain| mass_of(grain, materials)).collect(),
            id: (0..list.len() as u32).collect(),
            material: if uniform { Vec::new() } else { list.iter().map(|grain| grain.material.0).collect() },
            several_materials: !uniform,
            first_material,
            middle_velocity: vec![D::Vec::ZERO; list.len()],
            ..Self::default()
        })
    }

    /// Makes room for rotation, with these spins.
    pub(crate) fn rotate(&mut self, spins: impl Iterator<Item = D::Spin>) {
        self.turns = true;
        self.spin = spins.collect();
        self.spin_acceleration = vec![D::Spin::ZERO; self.spin.len()];
        self.middle_spin = vec![D::Spin::ZERO; self.spin.len()];
    }

    /// Makes sure that grains of this material can be told from others.
    pub(crate) fn expect_material(&mut self, material: MaterialId) {
        if self.len() == 0 && !self.several_materials {
            self.first_material = material.0;
        } else if !self.several_materials && material.0 != self.first_material {
            self.several_materials = true;
            self.material = vec![self.first_material; self.len()];
        }
    }

    /// Adds a grain with its identifier, mass \[kg\] and acceleration \[m/s^2\].
    pub(crate) fn push(&mut self, grain: &Grain<D>, (id, mass, gravity): (u32, f64, D::Vec)) {
        self.position.push(grain.position);
        self.velocity.push(grain.velocity);
        self.acceleration.push(gravity);
        self.radius.push(grain.radius);
        self.mass.push(mass);
        self.id.push(id);
        self.middle_velocity.push(D::Vec::ZERO);
        if self.several_materials {
            self.material.push(grain.material.0);
        }
        if self.takes_loads {
            self.load.push(Load::ZERO);
        }
        if !self.inertia.is_empty() {
            self.inertia.push(D::BALL_INERTIA * mass * grain.radius * grain.radius);
        }
        if !self.fixed.is_empty() {
            self.fixed.push(false);
            self.contact_mass.push(mass);
        }
        if self.turns {
            self.spin.push(grain.spin);
            self.spin_acceleration.push(D::Spin::ZERO);
            self.middle_spin.push(D::Spin::ZERO);
        }
    }

    /// Takes out the grains that do not stay; the others keep their order.
    pub(crate) fn retain(&mut self, stays: &[bool]) {
        keep(&mut self.position, stays);
        keep(&mut self.velocity, stays);
        keep(&mut self.acceleration, stays);
        keep(&mut self.radius, stays);
        keep(&mut self.mass, stays);
        keep(&mut self.id, stays);
        keep(&mut self.material, stays);
        keep(&mut self.load, stays);
        keep(&mut self.inertia, stays);
        keep(&mut self.fixed, stays);
        keep(&mut self.contact_mass, stays);
        keep(&mut self.spin, stays);
        keep(&mut self.spin_acceleration, stays);
        keep(&mut self.middle_velocity, stays);
        keep(&mut self.middle_spin, stays);
    }

    pub(crate) fn len(&self) -> usize {
        self.position.len()
    }

    pub(crate) fn material_of(&self, index: usize) -> usize {
        self.material.get(index).copied().unwrap_or(self.first_material) as usize
    }

    /// Smallest and largest radius \[m\].
    pub(crate) fn radius_range(&self) -> (f64, f64) {
        self.radius.iter().fold((f64::INFINITY, 0.0), |(low, high), &r| (r.min(low), r.max(high)))
    }

    /// Sorts all arrays along a space-filling curve. Returns the old index of each new place.
    pub(crate) fn sort(&mut self, cell: f64) -> Vec<u32> {
        let order = curve_order::<D>(&self.position, cell);
        permute(&mut self.position, &order);
        permute(&mut self.velocity, &order);
        permute(&mut self.acceleration, &order);
        permute(&mut self.radius, &order);
        permute(&mut self.mass, &order);
        permute(&mut self.id, &order);
        permute(&mut self.material, &order);
        permute(&mut self.load, &order);
        permute(&mut self.inertia, &order);
        permute(&mut self.fixed, &order);
        permute(&mut self.contact_mass, &order);
        permute(&mut self.spin, &order);
        permute(&mut self.spin_acceleration, &order);
        order
    }

    /// Bytes that each grain takes in these arrays.
    pub(crate) fn bytes_per_grain(&self) -> usize {
        let vectors = 4 * size_of::<D::Vec>() + 2 * size_of::<f64>() + size_of::<u32>();
        let material = if self.material.is_empty() { 0 } else { 1 };
        let rotation = if self.spin.is_empty() { 0 } else { 3 * size_of::<D::Spin>() };
        let load = if self.takes_loads { size_of::<Load<D>>() } else { 0 };
        let own = if self.inertia.is_empty() { 0 } else { size_of::<f64>() };
        let fixed = if self.fixed.is_empty() { 0 } else { size_of::<f64>() + 1 };
        vectors + material + rotation + load + own + fixed
    }

    pub(crate) fn save(&self, to: &mut Section) {
        to.put("position", &self.position);
        to.put("velocity", &self.velocity);
        to.put("acceleration", &self.acceleration);
        to.put("radius", &self.radius);
        to.put("mass", &self.mass);
        to.put("id", &self.id);
        to.put("material", &self.material);
        to.put("spin", &self.spin);
        to.put("spin acceleration", &self.spin_acceleration);
        if !self.inertia.is_empty() {
            to.put(INERTIA, &self.inertia);
        }
        if !self.fixed.is_empty() {
            to.put(FIXED, &self.fixed.iter().map(|&fixed| u8::from(fixed)).collect::<Vec<_>>());
        }
        if self.takes_loads {
            to.put(LOADS[0], &self.load.iter().map(|load| load.force).collect::<Vec<_>>());
            to.put(LOADS[1], &self.load.iter().map(|load| load.torque).collect::<Vec<_>>());
        }
    }

    /// Restores all grains; their number may differ only where grains come and go.
    pub(crate) fn restore(&mut self, from: &Section, any_number: bool) -> Result<(), SnapshotError> {
        let position: Vec<D::Vec> = from.array("position")?;
        let all = if any_number { position.len() } else { self.len() };
        let turning = if self.turns { all } else { 0 };
        let material = if self.several_materials { all } else { 0 };
        self.position = from.array_of("position", all)?;
        self.middle_velocity = vec![D::Vec::ZERO; all];
        self.middle_spin = vec![D::Spin::ZERO; turning];
        self.velocity = from.array_of("velocity", all)?;
        self.acceleration = from.array_of("acceleration", all)?;
        self.radius = from.array_of("radius", all)?;
        self.mass = from.array_of("mass", all)?;
        self.id = from.array_of("id", all)?;
        self.material = from.array_of("material", material)?;
        self.spin = from.array_of("spin", turning)?;
        self.spin_acceleration = from.array_of("spin acceleration", turning)?;
        self.restore_loads(from, all)?;
        self.restore_particulars(from, all)?;
        check_entry("position", self.position.iter().all(|x| x.is_finite()))?;
        check_entry("velocity", self.velocity.iter().all(|v| v.is_finite()))?;
        check_entry("acceleration", self.acceleration.iter().all(|a| a.is_finite()))?;
        check_entry("radius", self.radius.iter().all(|r| r.is_finite() && *r > 0.0))?;
        check_entry("mass", self.mass.iter().all(|m| m.is_finite() && *m > 0.0))?;
        check_entry("spin", self.spin.iter().all(|w| w.is_finite()))?;
        check_entry("spin acceleration", self.spin_acceleration.iter().all(|a| a.is_finite()))
    }
}

/// Names in a snapshot.
const LOADS: [&str; 2] = ["force of loads", "torque of loads"];
const INERTIA: &str = "moments of inertia";
const FIXED: &str = "fixed grains";
/// Mass of a fixed grain in contacts \[kg\]: the effective mass of a contact is
/// then that of the other grain, to the last bit but one.
const WITHOUT_END: f64 = 1e30;

impl<D: Dim> Grains<D> {
    /// Moment of inertia of a grain \[kg m^2; kg m in the plane\].
    pub(crate) fn inertia_of(&self, index: usize) -> f64 {
        let uniform = || D::BALL_INERTIA * self.mass[index] * self.radius[index].powi(2);
        self.inertia.get(index).copied().unwrap_or_else(uniform)
    }

    /// Masses \[kg\] as contacts see them.
    pub(crate) fn contact_mass(&self) -> &[f64] {
        if self.contact_mass.is_empty() { &self.mass } else { &self.contact_mass }
    }

    /// Whether some grain is not a free uniform ball.
    pub(crate) fn has_particulars(&self) -> bool {
        !(self.inertia.is_empty() && self.fixed.is_empty())
    }

    /// Largest ratio of `mass radius^2` to the moment of inertia.
    pub(crate) fn lightest_to_turn(&self) -> f64 {
        let ratio = |index: usize| self.mass[index] * self.radius[index].powi(2) / self.inertia[index];
        (0..self.inertia.len()).map(ratio).fold(1.0 / D::BALL_INERTIA, f64::max)
    }

    pub(crate) fn set_inertia(&mut self, index: usize, inertia: f64) {
        if self.inertia.is_empty() {
            self.inertia = (0..self.len()).map(|index| self.inertia_of(index)).collect();
        }
        self.inertia[index] = inertia;
    }

    /// Another mass \[kg\]; the moment of inertia changes with it.
    pub(crate) fn set_mass(&mut self, index: usize, mass: f64) {
        if let Some(inertia) = self.inertia.get_mut(index) {
            *inertia *= mass / self.mass[index];
        }
        self.mass[index] = mass;
        self.take_contact_masses();
    }

    /// Holds a grain at rest or lets it go.
    pub(crate) fn set_fixed(&mut self, index: usize, fixed: bool, gravity: D::Vec) {
        if self.fixed.is_empty() {
            self.fixed = vec![false; self.len()];
        }
        self.fixed[index] = fixed;
        self.acceleration[index] = if fixed { D::Vec::ZERO } else { gravity };
        if fixed {
            self.velocity[index] = D::Vec::ZERO;
            if self.turns {
                (self.spin[index], self.spin_acceleration[index]) = (D::Spin::ZERO, D::Spin::ZERO);
            }
        }
        if !self.fixed.contains(&true) {
            self.fixed = Vec::new();
        }
        self.take_contact_masses();
    }

    fn take_contact_masses(&mut self) {
        let mass = |(&fixed, &mass): (&bool, &f64)| if fixed { WITHOUT_END } else { mass };
        self.contact_mass = self.fixed.iter().zip(&self.mass).map(mass).collect();
    }

    fn restore_particulars(&mut self, from: &Section, all: usize) -> Result<(), SnapshotError> {
        let has = |entry: &str| from.entries().any(|(name, _)| name == entry);
        self.inertia = if has(INERTIA) { from.array_of(INERTIA, all)? } else { Vec::new() };
        check_entry(INERTIA, self.inertia.iter().all(|inertia| inertia.is_finite() && *inertia > 0.0))?;
        let fixed: Vec<u8> = if has(FIXED) { from.array_of(FIXED, all)? } else { Vec::new() };
        self.fixed = fixed.into_iter().map(|fixed| fixed != 0).collect();
        self.take_contact_masses();
        Ok(())
    }

    /// Loads of a snapshot; none where it has none and nothing asks for them.
    fn restore_loads(&mut self, from: &Section, all: usize) -> Result<(), SnapshotError> {
        self.takes_loads |= from.entries().any(|(name, _)| name == LOADS[0]);
        if !self.takes_loads {
            return Ok(());
        }
        let force: Vec<D::Vec> = from.array_of(LOADS[0], all)?;
        let torque: Vec<D::Spin> = from.array_of(LOADS[1], all)?;
        self.load = force.into_iter().zip(torque).map(|(force, torque)| Load { force, torque }).collect();
        check_entry(LOADS[0], self.load.iter().all(Load::is_finite))
    }
}

/// Mass of a grain \[kg; kg/m in the plane\].
fn mass_of<D: Dim>(grain: &Grain<D>, materials: &Materials) -> f64 {
    materials.get(grain.material).density * D::ball_volume(grain.radius)
}

fn keep<T>(values: &mut Vec<T>, stays: &[bool]) {
    let mut stays = stays.iter();
    values.retain(|_| stays.next().copied().unwrap_or(true));
}

fn permute<T: Copy>(values: &mut Vec<T>, order: &[u32]) {
    if !values.is_empty() {
        *values = order.iter().map(|&old| values[old as usize]).collect();
    }
}

/// Refuses radii \[m\] of which the smallest is nothing beside the largest: masses differ by the cube of that, and no step
/// suits both.
pub(crate) fn check_sizes(radii: impl Iterator<Item = f64>) -> Result<(), SetupError> {
    let (smallest, largest) =
        radii.fold((f64::INFINITY, 0.0_f64), |(low, high), r| (low.min(r), high.max(r)));
    if largest > LARGEST_RATIO * smallest {
        let what = format!("smallest radius of a grain, where the largest is {largest} m,");
        return Err(SetupError::new(what, smallest, "at least a millionth of the largest"));
    }
    Ok(())
}

/// Refuses a grain of which a value is out of range.
pub(crate) fn check<D: Dim>(grain: &Grain<D>, materials: &Materials) -> Result<(), SetupError> {
    if !(grain.radius.is_finite() && grain.radius > 0.0) {
        return Err(SetupError::new("radius of a grain", grain.radius, "positive and finite"));
    }
    if !(grain.position.is_finite() && grain.velocity.is_finite() && grain.spin.is_finite()) {
        return Err(SetupError::new("position, velocity or spin of a grain", f64::NAN, "finite"));
    }
    if grain.material.0 as usize >= materials.len() {
        let index = f64::from(grain.material.0);
        return Err(SetupError::new("material of a grain", index, "one of the materials of this set-up"));
    }
    // The moment of inertia is the smaller or the larger of the two.
    let inertia = mass_of(grain, materials) * grain.radius * grain.radius;
    if !inertia.is_normal() {
        let what = format!("moment of inertia of a grain of radius {:e} m", grain.radius);
        return Err(SetupError::new(what, inertia, "a number between 1e-307 and 1e308: take another radius"));
    }
    Ok(())
}
