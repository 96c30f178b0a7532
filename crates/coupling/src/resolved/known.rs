//! The grains that a law knows, in the order in which their solver holds them.

use super::grain::GrainInFluid;
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Grains, Linear, Load, Section, SnapshotError};

/// Grains as they were handed to the fluid.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Known<D: Dim> {
    pub(super) grains: Vec<GrainInFluid<D>>,
    /// Index by identifier, sorted.
    by_id: Vec<(u32, u32)>,
}

/// As a section holds a grain: what was seen, the velocity with which it was met, its last load and the one that it got.
type Stored<V, S> = ([f64; 12], ((V, S), ((V, S), (V, S))));

impl<D: Dim> Known<D> {
    /// Takes up the order of grains; returns whether any is new, or has changed its place.
    pub(super) fn follow(&mut self, grains: Grains<'_, D>) -> bool {
        let is_same = self.grains.len() == grains.len()
            && self.grains.iter().enumerate().all(|(k, grain)| grain.id == grains.id(k));
        if is_same {
            return false;
        }
        let before = std::mem::take(&mut self.grains);
        let by_id = &self.by_id;
        let found = |id: u32| index_in(by_id, id).map(|index| before[index]);
        self.grains = grains
            .iter()
            .map(|(id, motion, radius)| found(id).unwrap_or_else(|| GrainInFluid::new(id, &motion, radius)))
            .collect();
        self.sort();
        true
    }

    fn sort(&mut self) {
        self.by_id.clear();
        self.by_id.extend(self.grains.iter().zip(0..).map(|(grain, k)| (grain.id, k)));
        self.by_id.sort_unstable();
    }

    /// The grain of an identifier, which is expected at an index.
    pub(super) fn find(&self, index: usize, id: u32) -> Option<&GrainInFluid<D>> {
        let expected = self.grains.get(index).filter(|grain| grain.id == id);
        expected.or_else(|| index_in(&self.by_id, id).map(|index| &self.grains[index]))
    }

    pub(super) fn save(&self, to: &mut Section) {
        let ids: Vec<u32> = self.grains.iter().map(|grain| grain.id).collect();
        let pair = |load: &Load<D>| (load.force, load.torque);
        let stored = |grain: &GrainInFluid<D>| -> Stored<D::Vec, D::Spin> {
            let [a, b] = grain.seen;
            let seen = std::array::from_fn(|k| if k < 6 { a[k] } else { b[k - 6] });
            (seen, (grain.met[0], (pair(&grain.last), pair(&grain.load))))
        };
        to.put("identifiers of grains in the fluid", &ids);
        to.put("grains in the fluid", &self.grains.iter().map(stored).collect::<Vec<_>>());
    }

    pub(super) fn restored(from: &Section) -> Result<Self, SnapshotError> {
        let ids: Vec<u32> = from.array("identifiers of grains in the fluid")?;
        let stored: Vec<Stored<D::Vec, D::Spin>> = from.array_of("grains in the fluid", ids.len())?;
        let load = |(force, torque)| Load { force, torque };
        let grain = |(id, stored): (u32, Stored<D::Vec, D::Spin>)| {
            let (seen, (met, (last, held))) = stored;
            GrainInFluid {
                id,
                radius: [0.0; 2],
                seen: [std::array::from_fn(|k| seen[k]), std::array::from_fn(|k| seen[k + 6])],
                met: [met; 2],
                is_new: false,
                last: load(last),
                load: load(held),
            }
        };
        let mut known = Self { grains: ids.into_iter().zip(stored).map(grain).collect(), by_id: Vec::new() };
        check_entry("grains in the fluid", known.grains.iter().all(is_finite))?;
        known.sort();
        let is_twice = known.by_id.windows(2).any(|pair| pair[0].0 == pair[1].0);
        check_entry("identifiers of grains in the fluid", !is_twice)?;
        Ok(known)
    }
}

fn is_finite<D: Dim>(grain: &GrainInFluid<D>) -> bool {
    grain.seen.iter().flatten().all(|number| number.is_finite())
        && grain.met.iter().all(|(velocity, spin)| velocity.is_finite() && spin.is_finite())
        && grain.last.is_finite()
        && grain.load.is_finite()
}

fn index_in(by_id: &[(u32, u32)], id: u32) -> Option<usize> {
    by_id.binary_search_by_key(&id, |entry| entry.0).ok().map(|at| by_id[at].1 as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D2;
    use granular_core::glam::DVec2;

    fn follow(known: &mut Known<D2>, ids: &[u32]) -> bool {
        let zeros = vec![DVec2::ZERO; ids.len()];
        known.follow(Grains::new(&zeros, &zeros, &[], &vec![1.0; ids.len()], ids))
    }

    #[test]
    fn what_is_known_follows_its_grain() {
        let mut known = Known::default();
        assert!(follow(&mut known, &[0, 1, 2, 3]));
        for grain in &mut known.grains {
            (grain.load.torque, grain.is_new) = (f64::from(grain.id), false);
        }
        assert!(!follow(&mut known, &[0, 1, 2, 3]));
        // One has left, one has come, the others were sorted.
        assert!(follow(&mut known, &[3, 4, 0, 2]));
        let found: Vec<_> = known.grains.iter().map(|grain| (grain.load.torque, grain.is_new)).collect();
        assert_eq!(found, [(3.0, false), (0.0, true), (0.0, false), (2.0, false)]);
        assert_eq!(known.find(2, 3).map(|grain| grain.id), Some(3));
        assert_eq!(known.find(1, 1), None);
    }

    #[test]
    fn what_is_saved_comes_back_and_what_makes_no_sense_does_not() {
        let mut known = Known::default();
        follow(&mut known, &[5, 3]);
        for grain in &mut known.grains {
            (grain.radius, grain.is_new) = ([0.0; 2], false);
            grain.seen[1][2] = f64::from(grain.id);
        }
        let mut section = Section::new("law");
        known.save(&mut section);
        assert_eq!(Known::restored(&section).unwrap(), known);
        known.grains[1].id = 5;
        let mut section = Section::new("law");
        known.save(&mut section);
        assert!(Known::<D2>::restored(&section).is_err());
        (known.grains[1].id, known.grains[0].last.torque) = (3, f64::NAN);
        let mut section = Section::new("law");
        known.save(&mut section);
        assert!(Known::<D2>::restored(&section).is_err());
    }
}
