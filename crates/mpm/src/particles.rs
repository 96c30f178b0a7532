//! All particles, one array per property, body after body and in each body block after block.

use crate::load::Givers;
use crate::particle::Particle;
use granular_core::blocks::Divide;
use granular_core::snapshot::check_entry;
use granular_core::{Blocks, Dim, Linear, Section, SnapshotError, SymmetricTensor};
use std::ops::Range;

/// Components of the stress that are kept: xx, yy, zz, xy and in space yz, xz.
#[inline(always)]
pub(crate) const fn stress_components<D: Dim>() -> usize {
    if D::N == 2 { 4 } else { 6 }
}

/// Names of the components of the stress in snapshots.
const STRESS: [&str; 6] = ["stress xx", "stress yy", "stress zz", "stress xy", "stress yz", "stress xz"];

/// Names of moments of the velocity in snapshots.
const AFFINE: [&str; 3] = ["velocity along x", "velocity along y", "velocity along z"];

/// What is known of all particles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Particles<D: Dim> {
    pub(crate) position: Vec<D::Vec>,
    pub(crate) velocity: Vec<D::Vec>,
    pub(crate) mass: Vec<f64>,
    pub(crate) volume: Vec<f64>,
    /// One array per component that is kept; the others are empty.
    pub(crate) stress: [Vec<f64>; 6],
    /// Width of the particle, in cells; empty unless the shape functions have a width.
    pub(crate) width: Vec<f64>,
    /// Forces from outside \[N\]; empty unless there are any.
    pub(crate) load: Vec<D::Vec>,
    /// Mean over its nodes of the velocity times the way to them along each axis \[m/s cells\]; empty unless velocities are affine.
    pub(crate) affine: [Vec<D::Vec>; 3],
    /// Stable identifiers.
    pub(crate) id: Vec<u32>,
}

/// Room for one property while it is sorted.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spare<D: Dim> {
    vectors: Vec<D::Vec>,
    numbers: Vec<f64>,
    ids: Vec<u32>,
}

impl<D: Dim> Particles<D> {
    pub(crate) fn len(&self) -> usize {
        self.position.len()
    }

    /// Adds one at the end, with its width if shape functions have one, and moments of its velocity if that is affine.
    pub(crate) fn push(&mut self, particle: &Particle<D>, density: f64, width: Option<f64>, is_affine: bool) {
        self.position.push(particle.position);
        self.velocity.push(particle.velocity);
        self.mass.push(density * particle.volume);
        self.volume.push(particle.volume);
        for (kept, value) in
            self.stress.iter_mut().zip(components(particle.stress)).take(stress_components::<D>())
        {
            kept.push(value);
        }
        self.width.extend(width);
        if !self.load.is_empty() {
            self.load.push(D::Vec::ZERO);
        }
        if is_affine {
            self.affine.iter_mut().take(D::N).for_each(|along| along.push(D::Vec::ZERO));
        }
        self.id.push(self.id.len() as u32);
    }

    pub(crate) fn get(&self, index: usize) -> Particle<D> {
        Particle {
            position: self.position[index],
            velocity: self.velocity[index],
            volume: self.volume[index],
            stress: self.stress(index),
        }
    }

    /// What they give to nodes.
    pub(crate) fn givers(&self) -> Givers<'_, D> {
        Givers {
            position: &self.position,
            velocity: &self.velocity,
            mass: &self.mass,
            volume: &self.volume,
            stress: self.stress.each_ref().map(|component| &component[..]),
            width: &self.width,
            load: &self.load,
            affine: self.affine.each_ref().map(|along| &along[..]),
        }
    }

    pub(crate) fn stress(&self, index: usize) -> SymmetricTensor {
        let component = |k: usize| self.stress[k].get(index).copied().unwrap_or(0.0);
        SymmetricTensor {
            xx: component(0),
            yy: component(1),
            zz: component(2),
            xy: component(3),
            yz: component(4),
            xz: component(5),
        }
    }

    /// Brings those of a range into an order, given as where each comes from.
    pub(crate) fn permute(&mut self, range: Range<usize>, order: &[u32], spare: &mut Spare<D>) {
        permute(&mut self.position, range.clone(), order, &mut spare.vectors);
        permute(&mut self.velocity, range.clone(), order, &mut spare.vectors);
        permute(&mut self.mass, range.clone(), order, &mut spare.numbers);
        permute(&mut self.volume, range.clone(), order, &mut spare.numbers);
        for component in &mut self.stress[..stress_components::<D>()] {
            permute(component, range.clone(), order, &mut spare.numbers);
        }
        if !self.width.is_empty() {
            permute(&mut self.width, range.clone(), order, &mut spare.numbers);
        }
        if !self.load.is_empty() {
            permute(&mut self.load, range.clone(), order, &mut spare.vectors);
        }
        for along in self.affine.iter_mut().filter(|along| !along.is_empty()) {
            permute(along, range.clone(), order, &mut spare.vectors);
        }
        permute(&mut self.id, range, order, &mut spare.ids);
    }

    /// The first of a range that is not finite or has no volume, with what is wrong.
    pub(crate) fn unsound(&self) -> Option<(u32, &'static str)> {
        let fault = |k: usize| {
            let parts = [
                (self.velocity[k].is_finite(), "velocity"),
                (self.position[k].is_finite(), "position"),
                (
                    self.stress.iter().all(|component| component.get(k).is_none_or(|s| s.is_finite())),
                    "stress",
                ),
                (self.volume[k] > 0.0 && self.volume[k].is_finite(), "volume"),
            ];
            parts.into_iter().find(|(sound, _)| !sound).map(|(_, what)| (self.id[k], what))
        };
        (0..self.len()).find_map(fault)
    }

    pub(crate) fn save(&self, to: &mut Section) {
        to.put("position", &self.position);
        to.put("velocity", &self.velocity);
        to.put("mass", &self.mass);
        to.put("volume", &self.volume);
        for (name, component) in STRESS.iter().zip(&self.stress).take(stress_components::<D>()) {
            to.put(name, component);
        }
        if !self.width.is_empty() {
            to.put("width", &self.width);
        }
        to.put_one("is loaded", u8::from(!self.load.is_empty()));
        if !self.load.is_empty() {
            to.put("load", &self.load);
        }
        for (name, along) in AFFINE.iter().zip(&self.affine).filter(|(_, along)| !along.is_empty()) {
            to.put(name, along);
        }
        to.put("id", &self.id);
    }

    pub(crate) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let count = self.len();
        let numbers = |name: &str, fits: fn(f64) -> bool| -> Result<Vec<f64>, SnapshotError> {
            let values: Vec<f64> = from.array_of(name, count)?;
            check_entry(name, values.iter().all(|&value| fits(value)))?;
            Ok(values)
        };
        let vectors = |name: &str| -> Result<Vec<D::Vec>, SnapshotError> {
            let values: Vec<D::Vec> = from.array_of(name, count)?;
            check_entry(name, values.iter().all(|value| value.is_finite()))?;
            Ok(values)
        };
        let positive = |value: f64| value > 0.0 && value.is_finite();
        (self.position, self.velocity) = (vectors("position")?, vectors("velocity")?);
        (self.mass, self.volume) = (numbers("mass", positive)?, numbers("volume", positive)?);
        for (name, component) in STRESS.iter().zip(&mut self.stress).take(stress_components::<D>()) {
            *component = numbers(name, f64::is_finite)?;
        }
        if !self.width.is_empty() {
            self.width = numbers("width", positive)?;
        }
        self.load = if from.one::<u8>("is loaded")? == 0 { Vec::new() } else { vectors("load")? };
        for (name, along) in AFFINE.iter().zip(&mut self.affine).filter(|(_, along)| !along.is_empty()) {
            *along = vectors(name)?;
        }
        self.id = from.array_of("id", count)?;
        let mut seen = vec![false; count];
        let fits = self
            .id
            .iter()
            .all(|&id| seen.get_mut(id as usize).is_some_and(|seen| !std::mem::replace(seen, true)));
        check_entry("id", fits)
    }

    /// Bytes of one particle.
    pub(crate) fn bytes_each(&self) -> usize {
        let width = if self.width.is_empty() { 0 } else { 8 };
        let load = if self.load.is_empty() { 0 } else { size_of::<D::Vec>() };
        let affine = self.affine.iter().filter(|along| !along.is_empty()).count() * size_of::<D::Vec>();
        load + affine + 2 * size_of::<D::Vec>() + 8 * (2 + stress_components::<D>()) + width + 4
    }
}

/// Components in the order in which they are kept.
#[inline(always)]
pub(crate) fn components(stress: SymmetricTensor) -> [f64; 6] {
    let SymmetricTensor { xx, yy, zz, xy, yz, xz } = stress;
    [xx, yy, zz, xy, yz, xz]
}

/// Brings a range of an array into an order.
pub(crate) fn permute<T: Copy + Default + Send + Sync>(
    values: &mut [T],
    range: Range<usize>,
    order: &[u32],
    spare: &mut Vec<T>,
) {
    spare.resize(order.len(), T::default());
    let from = &values[range.clone()];
    let blocks = Blocks::new(order.len(), 8192);
    blocks.for_each(&mut spare[..], |block, spare| {
        for (to, &place) in spare.iter_mut().zip(&order[blocks.range(block)]) {
            *to = from[place as usize];
        }
    });
    values[range].copy_from_slice(spare);
}

/// Items that are cut between blocks where the blocks say.
#[derive(Debug)]
pub(crate) struct Cut<'a, T> {
    /// Where blocks begin, and the end of the last one; counted from the same item as `items`, or an earlier one.
    starts: &'a [u32],
    pub(crate) items: &'a mut [T],
}

impl<'a, T> Cut<'a, T> {
    /// `items` begin where the first block does.
    pub(crate) fn new(starts: &'a [u32], items: &'a mut [T]) -> Self {
        Self { starts, items }
    }
}

impl<T: Send> Divide for Cut<'_, T> {
    fn divide(self, blocks: usize, _: usize) -> (Self, Self) {
        let at = ((self.starts[blocks] - self.starts[0]) as usize).min(self.items.len());
        let (left, right) = self.items.split_at_mut(at);
        (
            Self { starts: &self.starts[..=blocks], items: left },
            Self { starts: &self.starts[blocks..], items: right },
        )
    }
}

/// What a step changes of some particles.
pub(crate) struct Changing<'a, D: Dim> {
    pub(crate) position: &'a mut [D::Vec],
    pub(crate) velocity: &'a mut [D::Vec],
    pub(crate) volume: &'a mut [f64],
    pub(crate) stress: [&'a mut [f64]; 6],
    pub(crate) affine: [&'a mut [D::Vec]; 3],
}

/// The same, cut between blocks.
#[derive(Debug)]
pub(crate) struct Parts<'a, D: Dim> {
    pub(crate) position: Cut<'a, D::Vec>,
    pub(crate) velocity: Cut<'a, D::Vec>,
    pub(crate) volume: Cut<'a, f64>,
    pub(crate) stress: [Cut<'a, f64>; 6],
    pub(crate) affine: [Cut<'a, D::Vec>; 3],
}

impl<'a, D: Dim> Parts<'a, D> {
    /// Particles of a body, whose blocks begin at `starts`.
    pub(crate) fn of(starts: &'a [u32], changing: Changing<'a, D>) -> Self {
        Self {
            position: Cut::new(starts, changing.position),
            velocity: Cut::new(starts, changing.velocity),
            volume: Cut::new(starts, changing.volume),
            stress: changing.stress.map(|component| Cut::new(starts, component)),
            affine: changing.affine.map(|along| Cut::new(starts, along)),
        }
    }
}

impl<D: Dim> Divide for Parts<'_, D> {
    fn divide(self, blocks: usize, size: usize) -> (Self, Self) {
        let (position, position_right) = self.position.divide(blocks, size);
        let (velocity, velocity_right) = self.velocity.divide(blocks, size);
        let (volume, volume_right) = self.volume.divide(blocks, size);
        let [a, b, c, d, e, f] = self.stress.map(|component| component.divide(blocks, size));
        let [x, y, z] = self.affine.map(|along| along.divide(blocks, size));
        (
            Self {
                position,
                velocity,
                volume,
                stress: [a.0, b.0, c.0, d.0, e.0, f.0],
                affine: [x.0, y.0, z.0],
            },
            Self {
                position: position_right,
                velocity: velocity_right,
                volume: volume_right,
                stress: [a.1, b.1, c.1, d.1, e.1, f.1],
                affine: [x.1, y.1, z.1],
            },
        )
    }
}
