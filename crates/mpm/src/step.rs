//! A step, stage by stage.

use crate::batch::{BATCH, Batch};
use crate::body::Pass;
use crate::choice::Give;
use crate::grid::grow;
use crate::layout::{LONGEST_TRAVEL, Node, block_cells};
use crate::load::{Givers, load_affine, load_outline};
use crate::motion::{Plan, Watch};
use crate::mpm::Mpm;
use crate::nodes::{Meeting, Touch};
use crate::particles::{Changing, Cut, Parts};
use crate::setup::Scheme;
use crate::wall::Wall;
use granular_core::{Dim, Linear, PerBlock, StepError, Vector};

/// Mass below which a node counts as empty, over that of the heaviest particle: momentum and force are left out with it. A particle on the
/// edge of a cell gives far more to the node beyond, see [`Linear`](crate::shape::Linear).
const LEAST_MASS: f64 = 1e-60;

/// What nodes do with what particles gave them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Forces act: the velocity after the step, and what it changed by.
    Accelerate,
    /// The velocity as it is, as the first or second vector; what walls do is found anew from forces, or known.
    Velocity(usize, bool),
}

impl<D: Dim> Mpm<D> {
    pub(crate) fn take_steps(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        for _ in 0..steps {
            self.check_stability(dt)?;
            self.one_step(dt)?;
        }
        if steps > 0 {
            self.moving.place(self.clock.time());
        }
        Ok(())
    }

    fn one_step(&mut self, dt: f64) -> Result<(), StepError> {
        self.moving.place_in_step(self.clock.time(), dt);
        self.touches.find(&self.grid, &self.walls, &self.moving);
        let ledger = self.options.ledger;
        let pic_share = self.options.velocity_update.pic_share(dt);
        let books_pic = self.kernels.affine.is_none();
        let plan = Plan { dt, pic_share, books_pic, ledger, ..Plan::default() };
        let watch = match self.options.scheme {
            Scheme::StressLast => self.stress_last(&plan),
            Scheme::StressFirst => self.stress_first(&plan),
            Scheme::ModifiedStressLast => self.modified_stress_last(&plan),
        };
        self.push_walls(dt);
        if !self.contacts.is_empty() {
            self.note_contacts(dt);
        }
        self.clock.step();
        self.steps += 1;
        self.look(dt, watch)
    }

    fn stress_last(&mut self, plan: &Plan) -> Watch {
        self.give(true);
        self.answer(plan.dt, Answer::Accelerate);
        self.take(&Plan { velocity: true, position: true, strain: Some(0), ..*plan })
    }

    fn stress_first(&mut self, plan: &Plan) -> Watch {
        self.give(true);
        self.answer(plan.dt, Answer::Velocity(0, true));
        let strained = self.take(&Plan { strain: Some(0), ..*plan });
        self.give(true);
        self.answer(plan.dt, Answer::Accelerate);
        strained.join(self.take(&Plan { velocity: true, position: true, ..*plan }))
    }

    fn modified_stress_last(&mut self, plan: &Plan) -> Watch {
        self.give(true);
        self.answer(plan.dt, Answer::Accelerate);
        let moved = self.take(&Plan { velocity: true, ..*plan });
        self.give(false);
        self.answer(plan.dt, Answer::Velocity(1, false));
        moved.join(self.take(&Plan { position: true, strain: Some(1), ..*plan }))
    }

    /// Particles give mass and momentum to tiles, and the force of their stresses.
    fn give(&mut self, force: bool) {
        if self.grid.fields > 1 {
            self.give_by_field(force);
        } else {
            self.fill_tiles(0, force);
        }
    }

    /// Particles of a field give to tiles.
    pub(crate) fn fill_tiles(&mut self, field: usize, force: bool) {
        let per_cell = 1.0 / self.grid.lattice.cell;
        let (load, force) = (self.kernels.load, force.then_some(per_cell));
        let affine = self.kernels.affine.map(|(give, _)| give);
        self.fill_tiles_with(field, affine, |rows, givers| load(rows, givers, force));
    }

    /// Particles of a field give to tiles where it ends.
    pub(crate) fn fill_tiles_with_outlines(&mut self, field: usize) {
        let frame = (self.grid.lattice.origin, 1.0 / self.grid.lattice.cell);
        self.fill_tiles_with(field, None, |rows, givers| load_outline(rows, givers, frame));
    }

    fn fill_tiles_with(
        &mut self,
        field: usize,
        affine: Option<Give<D>>,
        load: impl Fn(&mut [[Node; BATCH]; 4], &Givers<'_, D>) + Sync,
    ) {
        let Self { grid, groups, particles, tiles, kernels, .. } = self;
        let blocks = grid.tile_blocks();
        grow(tiles, grid.tile_nodes());
        tiles.resize(grid.tile_nodes(), Node::ZERO);
        for (k, group) in groups.iter().filter(|group| group.field == field).enumerate() {
            blocks.for_each(&mut tiles[..], |home, tile| {
                if k == 0 {
                    tile.fill(Node::ZERO);
                }
                let range = group.starts[home] as usize..group.starts[home + 1] as usize;
                if range.is_empty() {
                    return;
                }
                let (all, corner) = (particles.givers(), grid.corner(home));
                let mut batch = Batch::new();
                for from in range.clone().step_by(BATCH) {
                    let givers = all.range(from, (from + BATCH).min(range.end));
                    load(&mut batch.rows, &givers);
                    let places = (givers.position, givers.width);
                    (kernels.give)(&mut batch, grid.tile_shape(), &corner, places, tile);
                    if let Some(give_affine) = affine {
                        load_affine(&mut batch.rows, &givers);
                        give_affine(&mut batch, grid.tile_shape(), &corner, places, tile);
                    }
                }
            });
        }
    }

    /// Nodes collect what tiles hold, and find how they move.
    fn answer(&mut self, dt: f64, answer: Answer) {
        let walls = std::mem::take(&mut self.walls);
        let rule = NodeRule::<D> {
            dt,
            gravity: self.gravity,
            local_damping: self.options.local_damping,
            least_mass: LEAST_MASS * self.heaviest,
            walls: &walls,
            dt_per_cell: dt / self.grid.lattice.cell,
        };
        self.damped.resize(self.grid.node_blocks().count(), 0.0);
        if self.grid.fields > 1 {
            self.answer_by_field(&rule, answer);
        } else {
            self.answer_as_one(&rule, answer);
        }
        self.walls = walls;
        if answer == Answer::Accelerate && self.options.ledger {
            self.losses.damping += self.damped.iter().sum::<f64>();
        }
    }

    fn answer_as_one(&mut self, rule: &NodeRule<'_, D>, answer: Answer) {
        let Self { grid, tiles, touches, damped, .. } = self;
        let (mut sums, mut motion) = (std::mem::take(&mut grid.sums), std::mem::take(&mut grid.motion));
        let touching = Cut::new(&touches.starts, &mut touches.list);
        let work = (&mut sums[..], &mut motion[..], touching, PerBlock(&mut damped[..]));
        grid.node_blocks().for_each(work, |block, (sums, motion, touches, damped)| {
            grid.collect(block, tiles, sums);
            match answer {
                Answer::Accelerate => damped.0[0] = rule.accelerate(sums, motion, touches.items),
                Answer::Velocity(vector, anew) => rule.velocity(sums, motion, touches.items, (vector, anew)),
            }
        });
        (grid.sums, grid.motion) = (sums, motion);
    }

    /// Particles take what they change by.
    fn take(&mut self, plan: &Plan) -> Watch {
        let Self { grid, groups, particles, tiles, kernels, watches, .. } = self;
        let mut whole = Watch::default();
        for group in groups {
            watches.resize(grid.homes().len(), Watch::default());
            let starts = &group.starts[..];
            let range = starts[0] as usize..starts[starts.len() - 1] as usize;
            let range_length = range.len();
            let width = particles.width.get(range.clone()).unwrap_or(&[]);
            let stress = particles.stress.each_mut().map(|s| s.get_mut(range.clone()).unwrap_or(&mut []));
            let changing = Changing {
                position: &mut particles.position[range.clone()],
                velocity: &mut particles.velocity[range.clone()],
                volume: &mut particles.volume[range.clone()],
                stress,
                affine: particles.affine.each_mut().map(|a| a.get_mut(range.clone()).unwrap_or(&mut [])),
            };
            group.body.pass(Pass {
                plan,
                kernels,
                grid,
                starts,
                parts: Parts::of(starts, changing),
                mass: &particles.mass[range],
                width,
                density: group.density,
                field: group.field,
                tiles,
                watches,
            });
            let of_group = watches.iter().copied().fold(Watch::default(), Watch::join);
            if plan.strain.is_some() {
                group.looseness = of_group.stretched / range_length.max(1) as f64;
            }
            whole = whole.join(of_group);
        }
        whole
    }

    /// Sums how nodes pushed walls.
    fn push_walls(&mut self, dt: f64) {
        self.wall_forces.fill(D::Vec::ZERO);
        let mut work = 0.0;
        for touch in &self.touches.list {
            self.wall_forces[touch.wall as usize] -= touch.impulse() * (1.0 / dt);
            if self.options.ledger {
                self.losses.friction += touch.lost[0];
                self.losses.stopping += touch.lost[1];
                self.losses.absorbed += touch.lost[2];
                work += touch.impulse().dot(touch.velocity);
            }
        }
        if !self.moving.is_empty() {
            for (reaction, &force) in self.moving.reactions.iter_mut().zip(&self.wall_forces) {
                (reaction.force, reaction.power) = (force, 0.0);
            }
            self.moving.work += work;
            self.moving.take_reactions(dt, false);
        }
    }

    /// The one place where what is not finite is looked for. Sorts particles when one may have come to the edge of its tile.
    fn look(&mut self, dt: f64, watch: Watch) -> Result<(), StepError> {
        if !watch.is_sound() {
            return Err(self.unsound());
        }
        let [pic, plastic, viscous] = watch.lost;
        self.losses.pic += pic;
        self.losses.plastic += plastic;
        self.losses.viscous += viscous;
        self.fastest = f64::from_bits(watch.fastest).sqrt();
        self.travel += self.fastest * dt;
        if self.travel > LONGEST_TRAVEL * self.grid.lattice.cell {
            self.sort()?;
            self.watch_thin_walls()?;
        }
        Ok(())
    }

    fn unsound(&self) -> StepError {
        let (id, quantity) = self.particles.unsound().unwrap_or((0, "speed"));
        if quantity == "volume" {
            let index = self.particles.id.iter().position(|&other| other == id).unwrap_or(0);
            return StepError::TooStiff {
                what: format!("the volume of particle {id} in m^{}", D::N),
                value: self.particles.volume[index],
                allowed: f64::MIN_POSITIVE,
                hint: "it was turned inside out within a step: take shorter steps or larger cells".to_owned(),
            };
        }
        StepError::NotFinite { solver: "mpm", quantity, id: u64::from(id), step: self.steps }
    }
}

/// How nodes move.
pub(crate) struct NodeRule<'a, D: Dim> {
    dt: f64,
    gravity: D::Vec,
    pub(crate) local_damping: f64,
    least_mass: f64,
    walls: &'a [Wall<D>],
    /// Step over the edge of a cell \[s/m\].
    dt_per_cell: f64,
}

impl<D: Dim> NodeRule<'_, D> {
    /// Walls at a node with a mass.
    pub(crate) fn meeting<'t>(&'t self, touches: &'t mut [Touch<D>], mass: f64) -> Meeting<'t, D> {
        Meeting { touches, walls: self.walls, mass, dt_per_cell: self.dt_per_cell }
    }

    /// Mean velocity of what is on a node, and its change by forces; none on an empty node.
    pub(crate) fn mean(&self, sum: &Node) -> Option<(D::Vec, D::Vec)> {
        let mass = sum.0[0];
        if mass <= self.least_mass {
            return None;
        }
        let per_mass = 1.0 / mass;
        let mean = D::Vec::from_fn(|axis| sum.0[1 + axis] * per_mass);
        let force = D::Vec::from_fn(|axis| sum.0[1 + D::N + axis] * per_mass) + self.gravity;
        Some((mean, force * self.dt))
    }

    /// Forces act, then walls. Returns what local damping took.
    fn accelerate(&self, sums: &[Node], motion: &mut [Node], touches: &mut [Touch<D>]) -> f64 {
        let mut damped = 0.0;
        touches.iter_mut().for_each(Touch::rest);
        let mut touching = Touching { from: 0 };
        for (node, (sum, motion)) in sums.iter().zip(motion).enumerate().take(block_cells::<D>()) {
            let mut meeting = self.meeting(touching.of(node, touches), sum.0[0]);
            let Some((mean, change)) = self.mean(sum) else {
                *motion = Node::ZERO;
                continue;
            };
            let (before, mut after) = meeting.act(mean, change);
            if self.local_damping > 0.0 {
                let resisting = self.resisting(after - before, before);
                after = meeting.act(mean, change + resisting).1;
                damped -= sum.0[0] * resisting.dot((before + after) * 0.5);
            }
            put::<D>(motion, 0, after);
            put::<D>(motion, 1, after - before);
        }
        damped
    }

    /// Local damping: a share of the change of velocity, which walls have had their part in, against the velocity.
    pub(crate) fn resisting(&self, change: D::Vec, velocity: D::Vec) -> D::Vec {
        D::Vec::from_fn(|axis| {
            -self.local_damping * change.component(axis).abs() * sign(velocity.component(axis))
        })
    }

    /// The velocity of what is on nodes now, with what walls do in this step; `anew` finds what they do.
    fn velocity(
        &self,
        sums: &[Node],
        motion: &mut [Node],
        touches: &mut [Touch<D>],
        (vector, anew): (usize, bool),
    ) {
        let mut touching = Touching { from: 0 };
        for (node, (sum, motion)) in sums.iter().zip(motion).enumerate().take(block_cells::<D>()) {
            let mut meeting = self.meeting(touching.of(node, touches), sum.0[0]);
            let now = self.mean(sum).map_or(D::Vec::ZERO, |(mean, change)| {
                if anew {
                    meeting.act(mean, change);
                }
                meeting.hold(mean)
            });
            put::<D>(motion, vector, now);
        }
    }
}

/// Puts one of the vectors of a node.
pub(crate) fn put<D: Dim>(node: &mut Node, vector: usize, value: D::Vec) {
    for axis in 0..D::N {
        node.0[vector * D::N + axis] = value.component(axis);
    }
}

/// One of the vectors of a node.
pub(crate) fn vector_of<D: Dim>(node: &Node, vector: usize) -> D::Vec {
    D::Vec::from_fn(|axis| node.0[vector * D::N + axis])
}

/// Walks along the touches of a block, node by node.
struct Touching {
    from: usize,
}

impl Touching {
    fn of<'a, D: Dim>(&mut self, node: usize, touches: &'a mut [Touch<D>]) -> &'a mut [Touch<D>] {
        let from = self.from;
        self.from += touches[from..].iter().take_while(|touch| touch.node as usize == node).count();
        &mut touches[from..self.from]
    }
}

/// The sign of a number; zero for zero.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}
