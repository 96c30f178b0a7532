//! What the fluid shows: fields and numbers, computed when something asks for them.

use crate::lattice::Lattice;
use crate::lbm::Lbm;
use crate::obstacle::{Obstacle, Reference, cell_index};
use crate::real::Real;
use granular_core::{Blocks, Dim, FieldRef, FieldSink, Linear, Shown, ShownAs, Vector};

/// Cells of a block of a sum.
const BLOCK: usize = 4096;

const FIELDS: [(&str, &str, &str); 7] = [
    ("pressure", "Pa", "pressure over that at rest"),
    ("velocity", "m/s", "velocity"),
    ("speed", "m/s", "length of the velocity"),
    ("vorticity", "1/s", "curl of the velocity: a number in the plane, a vector in space"),
    (
        "q_criterion",
        "1/s^2",
        "half of the squared rotation less half of the squared strain: above zero in vortices",
    ),
    ("divergence", "1/s", "divergence of the velocity"),
    ("solid", "-", "number of the obstacle that covers the cell, 0 for fluid"),
];

const STREAM_FUNCTION: (&str, &str, &str) =
    ("stream_function", "m^2/s", "flow rate per depth between a point and the centre of the first cell");

const GRAIN_SHARE: (&str, &str, &str) = ("grain_share", "-", "share of the cell that grains cover");

const NUMBERS: [(&str, &str, &str); 5] = [
    ("mass", "kg", "mass of the fluid"),
    ("mass_excess", "kg", "mass of the fluid over that at the density at rest"),
    ("kinetic_energy", "J", "kinetic energy of the fluid"),
    ("enstrophy", "1/s^2", "mean of half the square of the vorticity"),
    ("largest_speed", "m/s", "largest speed of any cell"),
];

pub(crate) fn shown<L: Lattice<Q>, const Q: usize, T: Real>(lbm: &Lbm<L, Q, T>) -> Vec<Shown> {
    let of = |(name, unit, meaning): (&str, _, _), kind| Shown::new(name, unit, meaning, kind);
    let mut list: Vec<Shown> = FIELDS.map(|field| of(field, ShownAs::Field)).into();
    if L::Dim::N == 2 {
        list.push(of(STREAM_FUNCTION, ShownAs::Field));
    }
    if lbm.immersed.is_on {
        list.push(of(GRAIN_SHARE, ShownAs::Field));
    }
    list.extend(NUMBERS.map(|number| of(number, ShownAs::Number)));
    for obstacle in &lbm.setup.obstacles {
        for axis in L::Dim::AXES {
            let name = format!("force_on_{}_{axis}", obstacle.name);
            list.push(of((&name, "N", "force of the fluid on an obstacle"), ShownAs::Number));
        }
        let name = format!("torque_on_{}_z", obstacle.name);
        list.push(of((&name, "N m", "torque about z of the fluid on an obstacle"), ShownAs::Number));
        for name in coefficient_names(obstacle) {
            list.push(of((&name, "-", "force of the fluid over that of its reference"), ShownAs::Number));
        }
    }
    for gauge in &lbm.setup.gauges {
        let name = format!("pressure_at_{}", gauge.name);
        list.push(of((&name, "Pa", "pressure over that at rest at a gauge"), ShownAs::Number));
        for axis in L::Dim::AXES {
            let name = format!("velocity_at_{}_{axis}", gauge.name);
            list.push(of((&name, "m/s", "velocity at a gauge"), ShownAs::Number));
        }
    }
    list
}

pub(crate) fn show<L: Lattice<Q>, const Q: usize, T: Real>(lbm: &Lbm<L, Q, T>, sink: &mut dyn FieldSink) {
    show_fields(lbm, sink);
    show_numbers(lbm, sink);
    for (number, obstacle) in lbm.setup.obstacles.iter().enumerate() {
        let force = lbm.force_on(number);
        for (axis, name) in L::Dim::AXES.iter().enumerate() {
            let name = format!("force_on_{}_{name}", obstacle.name);
            if sink.wants(&name) {
                sink.number(&name, "N", force.component(axis));
            }
        }
        let name = format!("torque_on_{}_z", obstacle.name);
        if sink.wants(&name) {
            sink.number(&name, "N m", granular_core::Spin::z(lbm.torque_on(number)));
        }
        let scale = obstacle.reference.map_or(0.0, |Reference { speed, length }| {
            2.0 / (lbm.setup.density * speed * speed * length.powi(L::Dim::N as i32 - 1))
        });
        for (axis, name) in coefficient_names(obstacle).enumerate() {
            if sink.wants(&name) {
                sink.number(&name, "-", force.component(axis) * scale);
            }
        }
    }
    show_gauges(lbm, sink);
}

/// Names of drag and lift coefficients, for an obstacle that has a reference.
fn coefficient_names<D: Dim>(obstacle: &Obstacle<D>) -> impl Iterator<Item = String> + '_ {
    let names = ["drag", "lift"].map(|kind| format!("{kind}_coefficient_of_{}", obstacle.name));
    names.into_iter().filter(|_| obstacle.reference.is_some())
}

fn show_gauges<L: Lattice<Q>, const Q: usize, T: Real>(lbm: &Lbm<L, Q, T>, sink: &mut dyn FieldSink) {
    for gauge in &lbm.setup.gauges {
        let pressure = format!("pressure_at_{}", gauge.name);
        let velocity = L::Dim::AXES.iter().map(|axis| format!("velocity_at_{}_{axis}", gauge.name));
        let velocity: Vec<String> = velocity.collect();
        if !sink.wants(&pressure) && !velocity.iter().any(|name| sink.wants(name)) {
            continue;
        }
        let flow = lbm.flow_at(gauge.place);
        if sink.wants(&pressure) {
            sink.number(&pressure, "Pa", flow.map_or(f64::NAN, |flow| flow.pressure));
        }
        for (axis, name) in velocity.iter().enumerate() {
            if sink.wants(name) {
                sink.number(name, "m/s", flow.map_or(f64::NAN, |flow| flow.velocity.component(axis)));
            }
        }
    }
}

fn show_fields<L: Lattice<Q>, const Q: usize, T: Real>(lbm: &Lbm<L, Q, T>, sink: &mut dyn FieldSink) {
    if sink.wants("pressure") {
        sink.field("pressure", "Pa", FieldRef::Scalar(&lbm.pressures()));
    }
    if sink.wants("velocity") {
        sink.field("velocity", "m/s", L::Dim::vector_field(&lbm.velocities()));
    }
    if sink.wants("speed") {
        let values = lbm.map(|cell| lbm.flow(cell).map_or(0.0, |flow| flow.velocity.length()));
        sink.field("speed", "m/s", FieldRef::Scalar(&values));
    }
    if sink.wants("vorticity") {
        sink.field("vorticity", "1/s", L::Dim::spin_field(&lbm.vorticity()));
    }
    if sink.wants("q_criterion") {
        sink.field("q_criterion", "1/s^2", FieldRef::Scalar(&lbm.q_criterion()));
    }
    if sink.wants("divergence") {
        sink.field("divergence", "1/s", FieldRef::Scalar(&lbm.divergence()));
    }
    if sink.wants("stream_function")
        && let Some(values) = lbm.stream_function()
    {
        sink.field("stream_function", "m^2/s", FieldRef::Scalar(&values));
    }
    if lbm.immersed.is_on && sink.wants("grain_share") {
        sink.field("grain_share", "-", FieldRef::Scalar(&lbm.grain_shares()));
    }
    if sink.wants("solid") {
        let values = lbm.map(|cell| lbm.covered_by(cell));
        sink.field("solid", "-", FieldRef::Index(&values));
    }
}

fn show_numbers<L: Lattice<Q>, const Q: usize, T: Real>(lbm: &Lbm<L, Q, T>, sink: &mut dyn FieldSink) {
    let cell_mass = lbm.setup.density * lbm.setup.spacing.powi(L::Dim::N as i32);
    if sink.wants("mass") {
        sink.number("mass", "kg", cell_mass * (lbm.fluid_cells as f64 + lbm.excess()));
    }
    if sink.wants("mass_excess") {
        sink.number("mass_excess", "kg", cell_mass * lbm.excess());
    }
    if sink.wants("kinetic_energy") {
        let energy = |cell| lbm.flow(cell).map_or(0.0, |flow| 0.5 * flow.velocity.length_squared());
        sink.number("kinetic_energy", "J", cell_mass * lbm.sum(energy));
    }
    if sink.wants("enstrophy") {
        let vorticity = lbm.vorticity();
        let half = Blocks::new(vorticity.len(), BLOCK).sum(|i| 0.5 * vorticity[i].length_squared());
        sink.number("enstrophy", "1/s^2", half / lbm.fluid_cells as f64);
    }
    if sink.wants("largest_speed") {
        let speed = |i| lbm.flow(lbm.cell(i)).map_or(0.0, |flow| flow.velocity.length());
        sink.number("largest_speed", "m/s", Blocks::new(lbm.cells(), BLOCK).largest(speed));
    }
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    fn cells(&self) -> usize {
        self.setup.cells.iter().product()
    }

    pub(crate) fn cell(&self, index: usize) -> [usize; 3] {
        let [nx, ny, _] = self.setup.cells;
        [index % nx, index / nx % ny, index / (nx * ny)]
    }

    /// Number of the obstacle that covers a cell, from 1; 0 for fluid.
    pub(crate) fn covered_by(&self, cell: [usize; 3]) -> u32 {
        self.cover.get(cell_index(self.setup.cells, cell)).copied().map_or(0, u32::from)
    }

    /// One value per cell, x fastest.
    pub(crate) fn map<V: Copy + Default + Send>(&self, value: impl Fn([usize; 3]) -> V + Sync) -> Vec<V> {
        let mut values = vec![V::default(); self.cells()];
        let blocks = Blocks::new(values.len(), BLOCK);
        blocks.for_each(&mut values[..], |block, values| {
            for (value_of, index) in values.iter_mut().zip(blocks.range(block)) {
                *value_of = value(self.cell(index));
            }
        });
        values
    }

    fn sum(&self, value: impl Fn([usize; 3]) -> f64 + Sync) -> f64 {
        Blocks::new(self.cells(), BLOCK).sum(|i| value(self.cell(i)))
    }

    /// Sum of the density excess over all cells, in units of the mass of a cell.
    pub fn excess(&self) -> f64 {
        self.sum(|cell| {
            let place = self.populations.grid.place(cell.map(|x| x as i64));
            if self.is_fluid(cell) { self.moments(place).0 } else { 0.0 }
        })
    }

    /// Velocity \[m/s\] of all cells, x fastest; zero inside obstacles.
    pub fn velocities(&self) -> Vec<<L::Dim as Dim>::Vec> {
        self.map(|cell| self.flow(cell).map_or(<L::Dim as Dim>::Vec::ZERO, |flow| flow.velocity))
    }

    /// Curl of the velocity \[1/s\] of all cells, by central differences, and one-sided ones beside walls.
    pub fn vorticity(&self) -> Vec<<L::Dim as Dim>::Spin> {
        let velocities = self.velocities();
        self.map(|cell| {
            let mut curl = <L::Dim as Dim>::Spin::ZERO;
            if self.is_fluid(cell) {
                for axis in 0..L::Dim::N {
                    let slope = self.slope(&velocities, cell, axis);
                    curl += L::Dim::cross(Vector::along(axis, 1.0), slope);
                }
            }
            curl
        })
    }

    /// Derivative of the velocity along an axis \[1/s\].
    pub(crate) fn slope(
        &self,
        velocities: &[<L::Dim as Dim>::Vec],
        cell: [usize; 3],
        axis: usize,
    ) -> <L::Dim as Dim>::Vec {
        let of = |cell: [usize; 3]| velocities[cell_index(self.setup.cells, cell)];
        let ends = [self.neighbour(cell, axis, -1), self.neighbour(cell, axis, 1)];
        let count = ends.iter().flatten().count();
        let [low, high] = ends.map(|end| of(end.unwrap_or(cell)));
        (high - low) * (1.0 / (self.setup.spacing * count.max(1) as f64))
    }

    /// The fluid cell next to one along an axis, through periodic faces too.
    fn neighbour(&self, mut cell: [usize; 3], axis: usize, way: i64) -> Option<[usize; 3]> {
        let count = self.setup.cells[axis] as i64;
        let at = cell[axis] as i64 + way;
        let is_periodic = matches!(self.setup.faces[axis][0], crate::Face::Periodic);
        if !(0..count).contains(&at) && !is_periodic {
            return None;
        }
        cell[axis] = at.rem_euclid(count) as usize;
        self.is_fluid(cell).then_some(cell)
    }
}
