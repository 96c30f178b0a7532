//! What the solver shows: energies, the front of the flow, fields and contacts. Everything is
//! computed from the state when it is asked for.

use crate::contact::{Contact, Partner};
use crate::dem::Dem;
use crate::ledger::Losses;
use crate::view::View;
use granular_core::glam::DVec3;
use granular_core::{Dim, FieldRef, FieldSink, Linear, Shown, ShownAs, SymmetricTensor, Vector};

/// Energies \[J; J/m in the plane\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// In the field of gravity, zero at the origin.
    pub potential: f64,
    /// Of motion along each axis.
    pub kinetic: [f64; 3],
    /// Of rotation.
    pub rotational: f64,
    /// In the springs of contacts.
    pub contact: f64,
}

impl Energies {
    /// Of motion along all axes.
    pub fn translational(&self) -> f64 {
        self.kinetic.iter().sum()
    }

    /// All of it.
    pub fn mechanical(&self) -> f64 {
        self.potential + self.translational() + self.rotational + self.contact
    }
}

/// Grains nearer than this over the mean radius count as connected. Stiff grains in a flow touch
/// for moments only: by contacts alone the moving part would not belong to the main mass. At
/// rest the run-out of a column is the same for anything between 1 and 5 %.
const CONNECTED: f64 = 0.05;

impl<D: Dim> Dem<D> {
    /// Energies of the present state.
    pub fn energies(&self) -> Energies {
        let grains = &self.grains;
        let kinetic = |axis: usize| {
            self.blocks.sum(|i| 0.5 * grains.mass[i] * grains.velocity[i].component(axis).powi(2))
        };
        let mut contact = 0.0;
        self.visit_contacts(&mut |c| contact += c.energy);
        Energies {
            potential: -self.blocks.sum(|i| grains.mass[i] * grains.position[i].dot(self.gravity)),
            kinetic: std::array::from_fn(|axis| if axis < D::N { kinetic(axis) } else { 0.0 }),
            rotational: if self.turns() {
                self.blocks.sum(|i| 0.5 * grains.inertia_of(i) * grains.spin[i].length_squared())
            } else {
                0.0
            },
            contact,
        }
    }

    /// What the energy ledger misses \[J\]: energy at the start and put in since, less the
    /// present energy and all losses; the work of moving walls and of loads of others is put in. `None` unless the ledger is kept.
    pub fn energy_residual(&self) -> Option<f64> {
        let initial = self.initial_energy?;
        let of_cell = self.cell().map_or(0.0, |cell| cell.work());
        let put_in = self.injected + self.moving_walls.work + of_cell + self.load_work;
        Some(initial + put_in - self.energies().mechanical() - self.losses.total())
    }

    /// Visits all contacts that overlap, in a fixed order.
    pub fn visit_contacts(&self, visit: &mut dyn FnMut(Contact<D>)) {
        let laboratory = self.laboratory_velocities();
        let view = self.view();
        let velocity = laboratory.as_deref().unwrap_or(view.velocity);
        self.pairs.visit(&View { velocity, start_velocity: velocity, ..view }, visit);
    }

    /// Sum of momenta \[kg m/s\]; in a cell that deforms, of those relative to its flow.
    pub fn momentum(&self) -> D::Vec {
        let grains = &self.grains;
        (0..self.len()).fold(D::Vec::ZERO, |sum, i| sum + grains.velocity[i] * grains.mass[i])
    }

    /// Sum of angular momenta about the origin \[kg m^2/s\]; in a cell that deforms, relative to its flow.
    pub fn angular_momentum(&self) -> D::Spin {
        let grains = &self.grains;
        (0..self.len()).fold(D::Spin::ZERO, |sum, i| {
            let orbital = D::cross(grains.position[i], grains.velocity[i]) * grains.mass[i];
            let spin = grains.spin.get(i).copied().unwrap_or(D::Spin::ZERO);
            sum + orbital + spin * grains.inertia_of(i)
        })
    }

    /// Which grains belong to the main mass: the largest set of grains connected by contacts
    /// \[Kumar2014, section 4.2.1\], or by gaps below 5 % of the mean radius.
    pub fn main_mass(&self) -> Vec<bool> {
        let grains = &self.grains;
        let count = self.len();
        let gap = CONNECTED * grains.radius.iter().sum::<f64>() / count.max(1) as f64;
        let mut root: Vec<u32> = (0..count as u32).collect();
        self.pairs.visit_listed(&self.view(), &mut |first, second, distance| {
            if distance < grains.radius[first] + grains.radius[second] + gap {
                let (a, b) = (find(&mut root, first as u32), find(&mut root, second as u32));
                root[a.max(b) as usize] = a.min(b);
            }
        });
        let roots: Vec<u32> = (0..count as u32).map(|i| find(&mut root, i)).collect();
        let mut sizes = vec![0_u32; count];
        roots.iter().for_each(|&r| sizes[r as usize] += 1);
        let largest = (0..count).max_by_key(|&r| (sizes[r], std::cmp::Reverse(r)));
        roots.iter().map(|&r| Some(r as usize) == largest).collect()
    }

    /// Farthest point of the main mass along an axis \[m\]: the front of a flow along x, its
    /// height along the upward axis. Not a number without grains.
    pub fn reach(&self, axis: usize) -> f64 {
        self.reach_of(&self.main_mass(), axis)
    }

    /// Farthest point of some grains along an axis \[m\]; not a number when there are none.
    fn reach_of(&self, main: &[bool], axis: usize) -> f64 {
        let grains = &self.grains;
        if main.is_empty() {
            return f64::NAN;
        }
        self.blocks.largest(|i| {
            if main[i] { grains.position[i].component(axis) + grains.radius[i] } else { f64::NEG_INFINITY }
        })
    }

    /// Force on each wall \[N; N/m in the plane\].
    pub fn wall_forces(&self) -> Vec<D::Vec> {
        let mut forces = vec![D::Vec::ZERO; self.walls.len()];
        self.visit_contacts(&mut |contact| {
            if let Partner::Wall(wall) = contact.partner {
                forces[wall] -= contact.force;
            }
        });
        forces
    }

    /// Contacts of each grain, walls included.
    pub fn coordination(&self) -> Vec<u32> {
        let mut counts = vec![0; self.len()];
        self.visit_contacts(&mut |contact| {
            counts[contact.first] += 1;
            if let Partner::Grain(second) = contact.partner {
                counts[second] += 1;
            }
        });
        counts
    }

    /// Force of all contacts on each grain \[N; N/m in the plane\], walls included.
    pub fn contact_forces(&self) -> Vec<D::Vec> {
        let mut forces = vec![D::Vec::ZERO; self.len()];
        self.visit_contacts(&mut |contact| {
            forces[contact.first] += contact.force;
            if let Partner::Grain(second) = contact.partner {
                forces[second] -= contact.force;
            }
        });
        forces
    }

    /// Stress of each grain \[Pa\], positive in compression: the sum of `arm (x) force` over its
    /// contacts, over its volume \[VOR-7\].
    pub fn grain_stress(&self) -> Vec<SymmetricTensor> {
        let mut stress = vec![SymmetricTensor::ZERO; self.len()];
        let grains = &self.grains;
        self.visit_contacts(&mut |contact| {
            let force = DVec3::from(contact.force.padded());
            let normal = DVec3::from(contact.normal.padded());
            let mut add = |index: usize| {
                let radius = grains.radius[index];
                let arm = normal * ((radius - 0.5 * contact.overlap) / D::ball_volume(radius));
                stress[index] += SymmetricTensor::dyad(arm, force);
            };
            add(contact.first);
            if let Partner::Grain(second) = contact.partner {
                add(second);
            }
        });
        stress
    }
}

/// Root of a set, with the path halved on the way.
fn find(root: &mut [u32], mut index: u32) -> u32 {
    while root[index as usize] != index {
        root[index as usize] = root[root[index as usize] as usize];
        index = root[index as usize];
    }
    index
}

const NUMBERS: &[(&str, &str, &str)] = &[
    (
        "front",
        "m",
        "farthest point along x of the main mass: the largest set of grains that touch or nearly do; it falls back when \
         grains at the edge part from it",
    ),
    ("height", "m", "highest point of the main mass"),
    ("potential_energy", "J", "energy in the field of gravity, zero at the origin"),
    ("kinetic_energy", "J", "energy of motion, without rotation; in a cell relative to its flow"),
    ("kinetic_energy_x", "J", "energy of motion along x; in a cell relative to its flow"),
    ("kinetic_energy_y", "J", "energy of motion along y; in a cell relative to its flow"),
    ("kinetic_energy_z", "J", "energy of motion along z; in a cell relative to its flow"),
    ("rotational_energy", "J", "energy of rotation"),
    ("contact_energy", "J", "energy in the springs of contacts"),
    ("loss_sliding", "J", "energy lost by sliding between grains"),
    ("loss_sliding_at_walls", "J", "energy lost by sliding at walls"),
    ("loss_normal_damping", "J", "energy lost in normal dashpots"),
    ("loss_tangential_damping", "J", "energy lost in tangential dashpots"),
    ("loss_rolling", "J", "energy lost by rolling and twisting resistance"),
    ("energy_residual", "J", "what the energy ledger misses"),
    ("largest_overlap", "%", "largest overlap over the radius of the smaller grain"),
    ("contacts", "1", "number of contacts"),
    ("coordination", "1", "mean number of contacts per grain"),
    ("unconnected", "1", "grains that do not belong to the main mass"),
];

/// Shown when walls move.
const WALL_WORK: (&str, &str, &str) =
    ("wall_work", "J", "work of moving walls on grains; with the ledger only");

/// Shown when others put loads on grains.
const LOAD_WORK: (&str, &str, &str) =
    ("load_work", "J", "work of the loads of others, such as a fluid, on grains; with the ledger only");

const FIELDS: &[(&str, &str, &str)] = &[
    ("radius", "m", "radius"),
    ("velocity", "m/s", "velocity; in a cell that deforms its flow is part of it"),
    ("speed", "m/s", "magnitude of the velocity"),
    ("spin", "rad/s", "angular velocity"),
    ("id", "1", "stable identifier"),
    ("mass", "kg", "mass"),
    ("contact_count", "1", "contacts of the grain"),
    ("stress", "Pa", "stress of the grain, positive in compression"),
    ("force", "N", "force of all contacts on the grain"),
];

const LINKS: &[(&str, &str, &str)] = &[
    ("normal_force", "N", "force along the normal, positive when it repels"),
    ("contact_force", "N", "force on the first grain"),
    ("overlap", "m", "overlap"),
];

impl<D: Dim> Dem<D> {
    pub(crate) fn catalogue(&self) -> Vec<Shown> {
        let shown = |kind| {
            move |&(name, unit, meaning): &(&str, &'static str, &'static str)| {
                Shown::new(name, unit, meaning, kind)
            }
        };
        let mut list: Vec<Shown> = NUMBERS.iter().map(shown(ShownAs::Number)).collect();
        list.retain(|s| D::N == 3 || s.name != "kinetic_energy_z");
        for wall in &self.walls {
            for axis in D::AXES {
                let name = wall_force_name(&wall.name, axis);
                list.push(Shown::new(name, "N", "force on the wall", ShownAs::Number));
            }
        }
        if !self.moving_walls.is_empty() {
            list.push(shown(ShownAs::Number)(&WALL_WORK));
        }
        if self.grains.takes_loads {
            list.push(shown(ShownAs::Number)(&LOAD_WORK));
        }
        list.extend(self.wall_catalogue());
        list.extend(self.exchange_numbers().map(|(number, _)| shown(ShownAs::Number)(&number)));
        list.extend(self.cell_catalogue());
        list.extend(FIELDS.iter().map(shown(ShownAs::Field)));
        list.extend(LINKS.iter().map(shown(ShownAs::Link)));
        list
    }

    pub(crate) fn show_all(&self, sink: &mut dyn FieldSink) {
        self.show_numbers(sink);
        self.show_wall_forces(sink);
        self.show_wall_numbers(sink);
        for ((name, unit, _), value) in
            self.exchange_numbers().filter(|((name, ..), _)| sink.wants(name)).collect::<Vec<_>>()
        {
            sink.number(name, unit, value);
        }
        if !self.moving_walls.is_empty() && sink.wants(WALL_WORK.0) {
            sink.number(WALL_WORK.0, WALL_WORK.1, self.wall_work());
        }
        if self.grains.takes_loads && sink.wants(LOAD_WORK.0) {
            sink.number(LOAD_WORK.0, LOAD_WORK.1, self.load_work());
        }
        self.show_cell(sink);
        self.show_fields(sink);
        self.show_links(sink);
    }

    fn show_numbers(&self, sink: &mut dyn FieldSink) {
        let any = |sink: &dyn FieldSink, from: usize, to: usize| {
            NUMBERS[from..to].iter().any(|(name, ..)| sink.wants(name))
        };
        let mut values = vec![0.0; NUMBERS.len()];
        // One search for the main mass serves front, height and what is not connected to it.
        if any(sink, 0, 2) || any(sink, 18, 19) {
            let main = self.main_mass();
            (values[0], values[1]) = (self.reach_of(&main, 0), self.reach_of(&main, D::UP));
            values[18] = main.iter().filter(|&&main| !main).count() as f64;
        }
        if any(sink, 2, 9) {
            let energies = self.energies();
            let [x, y, z] = energies.kinetic;
            let shown = [
                energies.potential,
                energies.translational(),
                x,
                y,
                z,
                energies.rotational,
                energies.contact,
            ];
            values[2..9].copy_from_slice(&shown);
        }
        values[9..14].copy_from_slice(&Losses::to_array(self.losses));
        if any(sink, 14, 15) {
            values[14] = self.energy_residual().unwrap_or(f64::NAN);
        }
        if any(sink, 15, 16) {
            values[15] = 100.0 * self.deepest_overlap();
        }
        if any(sink, 16, 18) {
            let (mut contacts, mut ends) = (0, 0);
            self.visit_contacts(&mut |contact| {
                contacts += 1;
                ends += if matches!(contact.partner, Partner::Grain(_)) { 2 } else { 1 };
            });
            (values[16], values[17]) = (f64::from(contacts), f64::from(ends) / self.len().max(1) as f64);
        }
        for (&(name, unit, _), &value) in NUMBERS.iter().zip(&values) {
            if sink.wants(name) {
                sink.number(name, unit, value);
            }
        }
    }

    fn show_wall_forces(&self, sink: &mut dyn FieldSink) {
        let wanted = |name: &str| D::AXES.iter().any(|axis| sink.wants(&wall_force_name(name, axis)));
        if !self.walls.iter().any(|wall| wanted(&wall.name)) {
            return;
        }
        for (wall, force) in self.walls.iter().zip(self.wall_forces()) {
            for (axis, name) in D::AXES.iter().enumerate() {
                let name = wall_force_name(&wall.name, name);
                if sink.wants(&name) {
                    sink.number(&name, "N", force.component(axis));
                }
            }
        }
    }

    fn show_fields(&self, sink: &mut dyn FieldSink) {
        let grains = &self.grains;
        let moving = sink.wants("velocity") || sink.wants("speed");
        let laboratory = if moving { self.laboratory_velocities() } else { None };
        let velocities = laboratory.as_deref().unwrap_or(&grains.velocity);
        for &(name, unit, _) in FIELDS {
            if !sink.wants(name) {
                continue;
            }
            match name {
                "radius" => sink.field(name, unit, FieldRef::Scalar(&grains.radius)),
                "velocity" => sink.field(name, unit, D::vector_field(velocities)),
                "speed" => {
                    let speed: Vec<f64> = velocities.iter().map(|v| v.length()).collect();
                    sink.field(name, unit, FieldRef::Scalar(&speed));
                }
                "spin" if self.turns() => sink.field(name, unit, D::spin_field(&grains.spin)),
                // Nothing turns the grains and nothing is stored: an output that asks gets zeros.
                "spin" => sink.field(name, unit, D::spin_field(&vec![D::Spin::ZERO; self.len()])),
                "id" => sink.field(name, unit, FieldRef::Index(&grains.id)),
                "mass" => sink.field(name, unit, FieldRef::Scalar(&grains.mass)),
                "contact_count" => sink.field(name, unit, FieldRef::Index(&self.coordination())),
                "force" => sink.field(name, unit, D::vector_field(&self.contact_forces())),
                "stress" => sink.field(name, unit, FieldRef::Tensor(&self.grain_stress())),
                _ => {}
            }
        }
    }

    fn show_links(&self, sink: &mut dyn FieldSink) {
        if !LINKS.iter().any(|(name, ..)| sink.wants(name)) {
            return;
        }
        let (mut pairs, mut normal, mut force, mut overlap) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        self.visit_contacts(&mut |contact| {
            // A link across the faces of a cell would be drawn through all of it.
            let ordinary = contact.shift == [0; 3];
            if let (Partner::Grain(second), true) = (contact.partner, ordinary) {
                pairs.push([contact.first as u32, second as u32]);
                normal.push(contact.normal_force);
                force.push(contact.force);
                overlap.push(contact.overlap);
            }
        });
        sink.links(&pairs);
        let fields = [FieldRef::Scalar(&normal), D::vector_field(&force), FieldRef::Scalar(&overlap)];
        for (&(name, unit, _), field) in LINKS.iter().zip(fields) {
            if sink.wants(name) {
                sink.link_field(name, unit, field);
            }
        }
    }
}

fn wall_force_name(wall: &str, axis: &str) -> String {
    format!("force_on_{wall}_{axis}")
}
