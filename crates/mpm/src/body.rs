//! Bodies: particles of one law. The law is known when a body's pass is compiled; the solver calls it once per body.

use crate::batch::{BATCH, Batch, Corner};
use crate::choice::Kernels;
use crate::grid::Grid;
use crate::layout::Node;
use crate::motion::{Plan, Strains, Stress, Watch, cut, put_stress, stress_at};
use crate::particles::{Cut, Parts};
use crate::step::vector_of;
use granular_constitutive::{Axes, ConstitutiveLaw, Increment, Kept, Memory};
use granular_core::snapshot::check_entry;
use granular_core::{Dim, PerBlock, Section, SnapshotError, SymmetricTensor};
use multiversion::multiversion;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::Range;

/// A body, whatever its law.
pub(crate) trait Body<D: Dim>: Debug + Send + Sync {
    /// Makes room for particles that have not been strained.
    fn start(&mut self, count: usize);
    /// The numbers that particles remember.
    fn kept(&self) -> &'static [Kept];
    /// Number `k` of what a particle remembers.
    fn remembered(&self, index: usize, k: usize) -> f64;
    fn stored_energy(&self, index: usize, stress: SymmetricTensor) -> f64;
    fn wave_speed(&self, density: f64) -> f64;
    fn viscosity(&self) -> f64;
    fn permute(&mut self, order: &[u32]);
    /// Takes from the nodes what the particles change by.
    fn pass(&mut self, pass: Pass<'_, D>);
    fn save(&self, name: &str, to: &mut Section);
    fn restore(&mut self, name: &str, from: &Section) -> Result<(), SnapshotError>;
    /// Bytes that a particle remembers.
    fn bytes_each(&self) -> usize;
}

/// One pass from nodes to the particles of a body.
pub(crate) struct Pass<'a, D: Dim> {
    pub(crate) plan: &'a Plan,
    pub(crate) kernels: &'a Kernels<D>,
    pub(crate) grid: &'a Grid<D>,
    /// Where blocks begin among all particles.
    pub(crate) starts: &'a [u32],
    pub(crate) parts: Parts<'a, D>,
    pub(crate) mass: &'a [f64],
    pub(crate) width: &'a [f64],
    /// Density at the start.
    pub(crate) density: f64,
    /// The set of nodal motions that is its own.
    pub(crate) field: usize,
    pub(crate) tiles: &'a mut [Node],
    pub(crate) watches: &'a mut [Watch],
}

/// A body of a law.
#[derive(Clone, Debug)]
pub(crate) struct LawBody<A: Axes, L: ConstitutiveLaw> {
    law: L,
    memory: Vec<L::Memory>,
    spare: Vec<L::Memory>,
    axes: PhantomData<A>,
}

impl<A: Axes, L: ConstitutiveLaw> LawBody<A, L> {
    pub(crate) fn new(law: L) -> Self {
        Self { law, memory: Vec::new(), spare: Vec::new(), axes: PhantomData }
    }
}

impl<D: Dim, A: Axes + Debug, L: ConstitutiveLaw> Body<D> for LawBody<A, L> {
    fn start(&mut self, count: usize) {
        self.memory = vec![self.law.start(); count];
    }

    fn kept(&self) -> &'static [Kept] {
        L::KEPT
    }

    fn remembered(&self, index: usize, k: usize) -> f64 {
        self.memory[index].as_ref()[k]
    }

    fn stored_energy(&self, index: usize, stress: SymmetricTensor) -> f64 {
        self.law.stored_energy(stress, &self.memory[index])
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.law.wave_speed(density)
    }

    fn viscosity(&self) -> f64 {
        self.law.greatest_viscosity()
    }

    fn permute(&mut self, order: &[u32]) {
        if L::Memory::LEN > 0 {
            self.spare.resize(order.len(), L::Memory::ZERO);
            permute_memory(&mut self.memory, order, &mut self.spare);
        }
    }

    fn pass(&mut self, pass: Pass<'_, D>) {
        let Pass { plan, kernels, grid, starts, parts, mass, width, density, field, tiles, watches } = pass;
        let (law, origin) = (&self.law, starts[0]);
        let memory = Cut::new(starts, &mut self.memory);
        let work = (tiles, parts, memory, PerBlock(watches));
        grid.tile_blocks().for_each(work, |home, (tile, mut parts, memory, watch)| {
            if starts[home] == starts[home + 1] {
                watch.0[0] = Watch::default();
                return;
            }
            let among_all = (starts[home] - origin) as usize..(starts[home + 1] - origin) as usize;
            let mut block = BlockPass {
                plan,
                kernels,
                grid,
                corner: grid.corner(home),
                mass: &mass[among_all.clone()],
                width: width.get(among_all).unwrap_or(&[]),
                density,
                batch: Batch::new(),
                strains: Strains::new(),
            };
            grid.fetch(home, field, tile);
            watch.0[0] = block.run::<A, L>(law, tile, &mut parts, memory.items);
        });
    }

    fn save(&self, name: &str, to: &mut Section) {
        if L::Memory::LEN > 0 {
            let count = self.memory.len() * L::Memory::LEN;
            to.put_each(name, count, |put| {
                self.memory.iter().for_each(|memory| memory.as_ref().iter().for_each(|&value| put(value)));
            });
        }
    }

    fn restore(&mut self, name: &str, from: &Section) -> Result<(), SnapshotError> {
        if L::Memory::LEN == 0 {
            return Ok(());
        }
        let values: Vec<f64> = from.array_of(name, self.memory.len() * L::Memory::LEN)?;
        check_entry(name, values.iter().all(|value| value.is_finite()))?;
        for (memory, values) in self.memory.iter_mut().zip(values.chunks_exact(L::Memory::LEN)) {
            memory.as_mut().copy_from_slice(values);
        }
        Ok(())
    }

    fn bytes_each(&self) -> usize {
        8 * L::Memory::LEN
    }
}

fn permute_memory<M: Memory>(memory: &mut [M], order: &[u32], spare: &mut [M]) {
    for (to, &place) in spare.iter_mut().zip(order) {
        *to = memory[place as usize];
    }
    memory.copy_from_slice(spare);
}

/// The pass over the particles of one block.
struct BlockPass<'a, D: Dim> {
    plan: &'a Plan,
    kernels: &'a Kernels<D>,
    grid: &'a Grid<D>,
    corner: Corner<D>,
    mass: &'a [f64],
    width: &'a [f64],
    density: f64,
    batch: Batch,
    strains: Strains,
}

impl<D: Dim> BlockPass<'_, D> {
    fn run<A: Axes, L: ConstitutiveLaw>(
        &mut self,
        law: &L,
        tile: &[Node],
        parts: &mut Parts<'_, D>,
        memory: &mut [L::Memory],
    ) -> Watch {
        let mut watch = Watch::default();
        let count = parts.position.items.len();
        for from in (0..count).step_by(BATCH) {
            let range = from..(from + BATCH).min(count);
            if self.plan.velocity {
                self.take_affine(tile, parts, range.clone());
            }
            self.take(tile, parts, range.clone());
            let mass = &self.mass[range.clone()];
            (self.kernels.move_particles)(
                self.plan,
                &self.batch.rows[0],
                &mut parts.velocity.items[range.clone()],
                &mut parts.position.items[range.clone()],
                mass,
                &mut watch,
            );
            if let Some(vector) = self.plan.strain {
                let stress = &mut stress_of(&mut parts.stress, &range);
                let scale = (self.plan.dt * self.corner.per_cell, vector, self.density);
                let volume = &mut parts.volume.items[range.clone()];
                let (rows, strains) = (&self.batch.rows, &mut self.strains);
                (self.kernels.strain_particles)(scale, rows, strains, stress, volume, mass, &mut watch);
                let memory = &mut memory[range];
                let lost = respond::<D, A, L>(law, self.plan, &self.strains, stress, memory, volume);
                watch.lost[1] += lost[0];
                watch.lost[2] += lost[1];
            }
        }
        watch
    }

    /// Moments of the velocity after the step, if velocities are affine.
    fn take_affine(&mut self, tile: &[Node], parts: &mut Parts<'_, D>, range: Range<usize>) {
        let Some((_, take)) = self.kernels.affine else { return };
        let width = self.width.get(range.clone()).unwrap_or(&[]);
        let places = (&parts.position.items[range.clone()], width);
        take(&mut self.batch, self.grid.tile_shape(), &self.corner, places, tile);
        for (along, rows) in parts.affine.iter_mut().zip(&self.batch.rows[1..]).take(D::N) {
            for (moment, row) in along.items[range.clone()].iter_mut().zip(rows) {
                *moment = vector_of::<D>(row, 0);
            }
        }
    }

    fn take(&mut self, tile: &[Node], parts: &Parts<'_, D>, range: Range<usize>) {
        let width = self.width.get(range.clone()).unwrap_or(&[]);
        let particles = (&parts.position.items[range], width);
        (self.kernels.take)(&mut self.batch, self.grid.tile_shape(), &self.corner, particles, tile);
    }
}

/// Stresses of some particles.
fn stress_of<'a>(stress: &'a mut [Cut<'_, f64>; 6], range: &Range<usize>) -> Stress<'a> {
    stress.each_mut().map(|component| component.items.get_mut(range.clone()).unwrap_or(&mut []))
}

/// The law's answer to strains. Returns what was lost to plastic strain and to viscosity.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn respond<D: Dim, A: Axes, L: ConstitutiveLaw>(
    law: &L,
    plan: &Plan,
    strains: &Strains,
    stress: &mut Stress<'_>,
    memory: &mut [L::Memory],
    volume: &[f64],
) -> [f64; 2] {
    let count = volume.len().min(BATCH);
    let (memory, volume) = (&mut memory[..count], &volume[..count]);
    let stress = &mut cut::<D>(stress, count);
    let mut lost = [[0.0; BATCH]; 2];
    for k in 0..count {
        let increment =
            Increment { strain: strains.at(k), dt: plan.dt, volume_ratio: strains.volume_ratio[k] };
        let mut remembered = memory[k];
        let response = law.respond::<A>(stress_at::<D>(stress, k), &mut remembered, &increment);
        memory[k] = remembered;
        put_stress::<D>(stress, k, response.stress);
        if plan.ledger {
            lost[0][k] = response.plastic_work * volume[k];
            lost[1][k] = response.viscous_work * volume[k];
        }
    }
    if plan.ledger { lost.map(|lost| lost[..count].iter().sum()) } else { [0.0; 2] }
}
