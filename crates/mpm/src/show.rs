//! What the solver shows. Everything is computed from the state when it is asked for.

use crate::batch::{BATCH, Batch};
use crate::layout::{Node, block_cells};
use crate::ledger::Energies;
use crate::mpm::Mpm;
use granular_core::{Blocks, Dim, FieldRef, FieldSink, Linear, Shown, ShownAs, SymmetricTensor, Vector};
use std::cell::OnceCell;

type Entry = (&'static str, &'static str, &'static str);

const NUMBERS: [Entry; 23] = [
    (
        "front",
        "m",
        "farthest point along x of the main mass: of the largest set of cells with particles that touch",
    ),
    ("height", "m", "highest point of the main mass"),
    ("farthest", "m", "largest x of a particle"),
    ("potential_energy", "J", "energy in the field of gravity"),
    ("kinetic_energy", "J", "energy of motion"),
    ("kinetic_energy_x", "J", "energy of motion along x"),
    ("kinetic_energy_y", "J", "energy of motion along y"),
    ("kinetic_energy_z", "J", "energy of motion along z"),
    ("elastic_energy", "J", "energy stored by stresses"),
    ("loss_plastic", "J", "energy lost to plastic strain"),
    ("loss_viscous", "J", "energy lost to viscosity of the material"),
    ("loss_sliding_at_walls", "J", "energy lost to friction at walls"),
    ("loss_stopping_at_walls", "J", "energy lost where walls stop what moves into them"),
    ("loss_sliding_at_contacts", "J", "energy lost to friction between bodies in contact"),
    ("loss_stopping_at_contacts", "J", "energy lost where bodies in contact approach"),
    ("loss_absorbed", "J", "energy lost to walls that absorb waves"),
    ("loss_local_damping", "J", "energy lost to local damping"),
    ("loss_pic", "J", "energy lost to PIC in the velocity update"),
    ("energy_residual", "J", "energy that the ledger misses"),
    ("mass", "kg", "sum of masses"),
    ("max_speed", "m/s", "speed of the fastest particle"),
    (
        "mean_volume_ratio",
        "1",
        "mean volume of particles that carry stress over that at the start; of the loosest body",
    ),
    ("lowest", "m", "smallest height of a particle"),
];

const FIELDS: [Entry; 12] = [
    ("id", "1", "stable identifier"),
    ("body", "1", "number of the body"),
    ("radius", "m", "half the edge of the square or cube that the particle stands for"),
    ("velocity", "m/s", "velocity"),
    ("speed", "m/s", "length of the velocity"),
    ("mass_of_particle", "kg", "mass"),
    ("volume", "m^3", "volume; area in the plane"),
    ("density", "kg/m^3", "mass per volume"),
    ("stress", "Pa", "stress, positive in tension"),
    ("pressure", "Pa", "mean pressure, positive in compression"),
    ("strain_rate", "1/s", "symmetric part of the velocity gradient"),
    (
        "mobilised_friction",
        "1",
        "sine of the mobilised angle of friction: greatest shear stress over the pressure in its plane",
    ),
];

const NODE_FIELDS: [Entry; 2] =
    [("node_mass", "kg", "mass on the node"), ("node_velocity", "m/s", "velocity of the node")];

/// Mass and velocity of nodes.
struct OnNodes<D: Dim> {
    place: Vec<D::Vec>,
    mass: Vec<f64>,
    velocity: Vec<D::Vec>,
}

impl<D: Dim> Mpm<D> {
    pub(crate) fn catalogue(&self) -> Vec<Shown> {
        let shown = |kind| move |&(name, unit, meaning): &Entry| Shown::new(name, unit, meaning, kind);
        let mut list: Vec<Shown> = NUMBERS.iter().map(shown(ShownAs::Number)).collect();
        list.retain(|shown| D::N == 3 || shown.name != "kinetic_energy_z");
        for axis in D::AXES {
            let name = format!("momentum_{axis}");
            list.push(Shown::new(name, "kg m/s", "sum of momenta", ShownAs::Number));
        }
        for (wall, axis) in self.walls.iter().flat_map(|wall| D::AXES.iter().map(move |axis| (wall, axis))) {
            let name = wall_force_name(&wall.name, axis);
            list.push(Shown::new(name, "N", "force on the wall", ShownAs::Number));
        }
        list.extend(FIELDS.iter().map(shown(ShownAs::Field)));
        for (name, unit) in self.kept() {
            list.push(Shown::new(name, unit, "what the law remembers", ShownAs::Field));
        }
        list.extend(NODE_FIELDS.iter().map(shown(ShownAs::Field)).map(|shown| shown.at("nodes")));
        list
    }

    /// What laws remember: names and units, each once.
    fn kept(&self) -> Vec<(&'static str, &'static str)> {
        let mut kept: Vec<(&str, &str)> = Vec::new();
        for number in self.groups.iter().flat_map(|group| group.body.kept()) {
            if kept.iter().all(|&(name, _)| name != number.name) {
                kept.push((number.name, number.unit));
            }
        }
        kept
    }

    pub(crate) fn show_all(&self, sink: &mut dyn FieldSink) {
        self.show_numbers(sink);
        self.show_fields(sink);
        self.show_kept(sink);
        self.show_nodes(sink);
    }

    fn show_numbers(&self, sink: &mut dyn FieldSink) {
        // Several numbers come of one pass over the particles each.
        let (energies, main_mass) = (OnceCell::new(), OnceCell::new());
        let energies = || *energies.get_or_init(|| self.energies());
        let main_mass = || *main_mass.get_or_init(|| self.front_and_height());
        for (name, unit, _) in NUMBERS {
            if sink.wants(name) && (D::N == 3 || name != "kinetic_energy_z") {
                sink.number(name, unit, self.number(name, &energies, &main_mass));
            }
        }
        let momentum = self.momentum();
        for (k, axis) in D::AXES.iter().enumerate() {
            let name = format!("momentum_{axis}");
            if sink.wants(&name) {
                sink.number(&name, "kg m/s", momentum.component(k));
            }
        }
        for (wall, force) in self.walls.iter().zip(&self.wall_forces) {
            for (k, axis) in D::AXES.iter().enumerate() {
                let name = wall_force_name(&wall.name, axis);
                if sink.wants(&name) {
                    sink.number(&name, "N", force.component(k));
                }
            }
        }
    }

    fn number(&self, name: &str, energies: &dyn Fn() -> Energies, main_mass: &dyn Fn() -> [f64; 2]) -> f64 {
        let farthest = |axis: usize, sign: f64| {
            let along = self.particles.position.iter().map(|at| sign * at.component(axis));
            sign * along.fold(f64::NEG_INFINITY, f64::max)
        };
        match name {
            "front" => main_mass()[0],
            "height" => main_mass()[1],
            "farthest" => farthest(0, 1.0),
            "lowest" => farthest(D::UP, -1.0),
            "potential_energy" => energies().potential,
            "kinetic_energy" => energies().translational(),
            "kinetic_energy_x" => energies().kinetic[0],
            "kinetic_energy_y" => energies().kinetic[1],
            "kinetic_energy_z" => energies().kinetic[2],
            "elastic_energy" => energies().elastic,
            "loss_plastic" => self.losses.plastic,
            "loss_viscous" => self.losses.viscous,
            "loss_sliding_at_walls" => self.losses.friction,
            "loss_stopping_at_walls" => self.losses.stopping,
            "loss_sliding_at_contacts" => self.losses.contact_friction,
            "loss_stopping_at_contacts" => self.losses.contact_stopping,
            "loss_absorbed" => self.losses.absorbed,
            "loss_local_damping" => self.losses.damping,
            "loss_pic" => self.losses.pic,
            "energy_residual" => self.energy_residual().unwrap_or(f64::NAN),
            "mass" => self.mass(),
            "max_speed" => self.particles.velocity.iter().map(|v| v.length()).fold(0.0, f64::max),
            _ => self.groups.iter().map(|group| group.looseness).fold(0.0, f64::max),
        }
    }

    fn show_fields(&self, sink: &mut dyn FieldSink) {
        let particles = &self.particles;
        for (name, unit, _) in FIELDS {
            if !sink.wants(name) {
                continue;
            }
            let tensors = |of: &dyn Fn(usize) -> SymmetricTensor| -> Vec<SymmetricTensor> {
                (0..self.len()).map(of).collect()
            };
            let numbers = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..self.len()).map(of).collect() };
            match name {
                "id" => sink.field(name, unit, FieldRef::Index(&particles.id)),
                "body" => sink.field(name, unit, FieldRef::Index(&self.body_numbers())),
                "radius" => {
                    let root = 1.0 / D::N as f64;
                    let radius = numbers(&|k| 0.5 * particles.volume[k].powf(root));
                    sink.field(name, unit, FieldRef::Scalar(&radius));
                }
                "speed" => {
                    let speed = numbers(&|k| particles.velocity[k].length());
                    sink.field(name, unit, FieldRef::Scalar(&speed));
                }
                "velocity" => sink.field(name, unit, D::vector_field(&particles.velocity)),
                "mass_of_particle" => sink.field(name, unit, FieldRef::Scalar(&particles.mass)),
                "volume" => sink.field(name, unit, FieldRef::Scalar(&particles.volume)),
                "density" => {
                    let density = numbers(&|k| particles.mass[k] / particles.volume[k]);
                    sink.field(name, unit, FieldRef::Scalar(&density));
                }
                "stress" => sink.field(name, unit, FieldRef::Tensor(&tensors(&|k| particles.stress(k)))),
                "pressure" => {
                    let pressure = numbers(&|k| -particles.stress(k).trace() / 3.0);
                    sink.field(name, unit, FieldRef::Scalar(&pressure));
                }
                "strain_rate" => sink.field(name, unit, FieldRef::Tensor(&self.strain_rates())),
                _ => {
                    let mobilised = numbers(&|k| mobilised(particles.stress(k)));
                    sink.field(name, unit, FieldRef::Scalar(&mobilised));
                }
            }
        }
    }

    /// Number of the body of each particle.
    fn body_numbers(&self) -> Vec<u32> {
        let mut bodies = vec![0; self.len()];
        for (body, group) in self.groups.iter().enumerate() {
            let last = *group.starts.last().unwrap_or(&0) as usize;
            bodies[group.starts[0] as usize..last].fill(body as u32);
        }
        bodies
    }

    /// What laws remember; zero for particles whose law does not.
    fn show_kept(&self, sink: &mut dyn FieldSink) {
        for (name, unit) in self.kept().into_iter().filter(|(name, _)| sink.wants(name)).collect::<Vec<_>>() {
            let mut values = vec![0.0; self.len()];
            for group in &self.groups {
                let Some(k) = group.body.kept().iter().position(|kept| kept.name == name) else { continue };
                let (first, last) = (group.starts[0] as usize, *group.starts.last().unwrap_or(&0) as usize);
                for (index, value) in values[first..last].iter_mut().enumerate() {
                    *value = group.body.remembered(index, k);
                }
            }
            sink.field(name, unit, FieldRef::Scalar(&values));
        }
    }

    fn show_nodes(&self, sink: &mut dyn FieldSink) {
        if !NODE_FIELDS.iter().any(|(name, ..)| sink.wants(name)) {
            return;
        }
        let OnNodes { mass, velocity, .. } = self.on_nodes();
        let [(name, unit, _), (velocity_name, velocity_unit, _)] = NODE_FIELDS;
        if sink.wants(name) {
            sink.field(name, unit, FieldRef::Scalar(&mass));
        }
        if sink.wants(velocity_name) {
            sink.field(velocity_name, velocity_unit, D::vector_field(&velocity));
        }
    }

    /// Places of nodes that hold mass.
    pub(crate) fn node_places(&self) -> &[D::Vec] {
        self.node_places.get_or_init(|| self.on_nodes().place)
    }

    /// Tiles with the mass and momentum of particles as they are, of one field or all.
    fn tiles_now(&self, field: Option<usize>) -> Vec<Node> {
        let (grid, all) = (&self.grid, self.particles.givers());
        let mut tiles = vec![Node::ZERO; grid.tile_nodes()];
        for group in self.groups.iter().filter(|group| field.is_none_or(|field| group.field == field)) {
            grid.tile_blocks().for_each(&mut tiles[..], |home, tile| {
                let range = group.starts[home] as usize..group.starts[home + 1] as usize;
                let mut batch = Batch::new();
                for from in range.clone().step_by(BATCH) {
                    let givers = all.range(from, (from + BATCH).min(range.end));
                    (self.kernels.load)(&mut batch.rows, &givers, None);
                    let places = (givers.position, givers.width);
                    (self.kernels.give)(&mut batch, grid.tile_shape(), &grid.corner(home), places, tile);
                }
            });
        }
        tiles
    }

    /// Mass and momentum of all nodes, of one field or all.
    fn sums_now(&self, field: Option<usize>) -> Vec<Node> {
        let tiles = self.tiles_now(field);
        let cells = block_cells::<D>();
        let blocks = Blocks::new(self.grid.blocks().len() * cells, cells);
        let mut sums = vec![Node::ZERO; self.grid.blocks().len() * cells];
        blocks.for_each(&mut sums[..], |block, sums| self.grid.collect(block, &tiles, sums));
        sums
    }

    fn on_nodes(&self) -> OnNodes<D> {
        let mut nodes = OnNodes { place: Vec::new(), mass: Vec::new(), velocity: Vec::new() };
        for (k, node) in self.sums_now(None).iter().enumerate().filter(|(_, node)| node.0[0] > 0.0) {
            let cells = block_cells::<D>();
            nodes.place.push(self.grid.lattice.node(self.grid.blocks()[k / cells], k % cells));
            nodes.mass.push(node.0[0]);
            nodes.velocity.push(D::Vec::from_fn(|axis| node.0[1 + axis] / node.0[0]));
        }
        nodes
    }

    /// Symmetric part of the velocity gradient at each particle, of the velocities of its own field.
    fn strain_rates(&self) -> Vec<SymmetricTensor> {
        let mut grid = self.grid.clone();
        grid.set_fields(1);
        let mut rates = vec![SymmetricTensor::ZERO; self.len()];
        let mut tile = vec![Node::ZERO; grid.tile_shape().nodes];
        for field in 0..self.grid.fields {
            for (node, motion) in self.sums_now(Some(field)).iter().zip(&mut grid.motion) {
                *motion = Node::ZERO;
                for axis in (0..D::N).filter(|_| node.0[0] > 0.0) {
                    motion.0[axis] = node.0[1 + axis] / node.0[0];
                }
            }
            for group in self.groups.iter().filter(|group| group.field == field) {
                for home in 0..grid.homes().len() {
                    let range = group.starts[home] as usize..group.starts[home + 1] as usize;
                    if !range.is_empty() {
                        grid.fetch(home, 0, &mut tile);
                        self.rates_in(home, &tile, range, &mut rates);
                    }
                }
            }
        }
        rates
    }

    fn rates_in(
        &self,
        home: usize,
        tile: &[Node],
        range: std::ops::Range<usize>,
        rates: &mut [SymmetricTensor],
    ) {
        let (all, corner) = (self.particles.givers(), self.grid.corner(home));
        let mut batch = Batch::new();
        for from in range.clone().step_by(BATCH) {
            let takers = all.range(from, (from + BATCH).min(range.end));
            let places = (takers.position, takers.width);
            (self.kernels.take)(&mut batch, self.grid.tile_shape(), &corner, places, tile);
            for (k, rate) in rates[from..(from + BATCH).min(range.end)].iter_mut().enumerate() {
                let gradient = |row: usize, column: usize| {
                    if row < D::N && column < D::N {
                        batch.rows[1 + column][k].0[row] * corner.per_cell
                    } else {
                        0.0
                    }
                };
                let mean = |a: usize, b: usize| 0.5 * (gradient(a, b) + gradient(b, a));
                *rate = SymmetricTensor {
                    xx: mean(0, 0),
                    yy: mean(1, 1),
                    zz: mean(2, 2),
                    xy: mean(0, 1),
                    yz: mean(1, 2),
                    xz: mean(0, 2),
                };
            }
        }
    }
}

fn wall_force_name(wall: &str, axis: &str) -> String {
    format!("force_on_{wall}_{axis}")
}

/// Sine of the mobilised angle of friction, `(s1 - s3) / -(s1 + s3)`; zero without pressure.
fn mobilised(stress: SymmetricTensor) -> f64 {
    let [greatest, _, least] = principal(stress);
    let pressure = -(greatest + least);
    if pressure > 0.0 { (greatest - least) / pressure } else { 0.0 }
}

/// Principal values, the greatest first; trigonometric form.
fn principal(stress: SymmetricTensor) -> [f64; 3] {
    let (mean, deviator) = (stress.trace() / 3.0, stress.deviator());
    let SymmetricTensor { xx, yy, zz, xy, yz, xz } = deviator;
    let second = 0.5 * deviator.contract(deviator);
    if second == 0.0 {
        return [mean; 3];
    }
    let third = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    let radius = (second / 3.0).sqrt();
    let angle = (third / (2.0 * radius.powi(3))).clamp(-1.0, 1.0).acos() / 3.0;
    let third_of_turn = std::f64::consts::TAU / 3.0;
    let value = |turn: f64| mean + 2.0 * radius * (angle + turn).cos();
    // The angle is within a sixth of a turn, so that this is their order.
    [value(0.0), value(-third_of_turn), value(third_of_turn)]
}
