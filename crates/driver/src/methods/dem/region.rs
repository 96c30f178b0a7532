//! Regions to which a sample is cut.

use crate::problems::Problems;
use crate::scene::region::RegionSpec;
use granular_core::units::Length;
use granular_core::{Dim, Linear, Vector};

/// A region, of which a ball may be wholly inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Region<D: Dim> {
    Box { low: D::Vec, high: D::Vec },
    HalfSpace { point: D::Vec, normal: D::Vec },
    Cylinder { from: D::Vec, axis: D::Vec, length: f64, radius: f64 },
}

impl<D: Dim> Region<D> {
    /// The region of a scene, or what is wrong with it.
    pub(super) fn of(path: &str, spec: &RegionSpec, problems: &mut Problems) -> Option<Self> {
        let mut point = |key: &str, at: &[Length]| problems.vector::<D, _>(&format!("{path}.{key}"), at);
        match spec {
            RegionSpec::Box { low, high } => {
                let (low, high) = (point("low", low), point("high", high));
                let (low, high) = (low?, high?);
                if low.max(high) == high {
                    return Some(Self::Box { low, high });
                }
                problems.add(
                    path,
                    "a box whose high is below its low",
                    "low below high along every axis",
                    "",
                );
            }
            RegionSpec::HalfSpace { point: on, normal } => {
                let numbers: Vec<Length> = normal.iter().map(|&number| number.into()).collect();
                let (on, normal) = (point("point", on), point("normal", &numbers));
                let (on, normal) = (on?, normal?);
                if normal.length() > 0.0 {
                    return Some(Self::HalfSpace { point: on, normal: normal * (1.0 / normal.length()) });
                }
                problems.add(format!("{path}.normal"), "of no length", "a direction", "");
            }
            RegionSpec::Cylinder { .. } if D::AXES.len() < 3 => {
                problems.add(path, "Cylinder", "a scene in space", "in the plane a Box does the same");
            }
            RegionSpec::Cylinder { from, to, radius } => {
                let (from, to) = (point("from", from), point("to", to));
                let (from, to) = (from?, to?);
                let (axis, length) = (to - from, (to - from).length());
                if length > 0.0 && radius.value() > 0.0 {
                    let axis = axis * (1.0 / length);
                    return Some(Self::Cylinder { from, axis, length, radius: radius.value() });
                }
                problems.add(
                    path,
                    "a cylinder without extent",
                    "a positive radius, `from` apart from `to`",
                    "",
                );
            }
        }
        None
    }

    /// Whether a ball lies wholly inside.
    pub(super) fn holds(&self, position: D::Vec, radius: f64) -> bool {
        let reach = match *self {
            Self::Box { low, high } => (0..D::N)
                .map(|axis| (position - low).component(axis).min((high - position).component(axis)))
                .fold(f64::INFINITY, f64::min),
            Self::HalfSpace { point, normal } => (position - point).dot(normal),
            Self::Cylinder { from, axis, length, radius } => {
                let arm = position - from;
                let along = arm.dot(axis);
                let across = (arm - axis * along).length();
                (radius - across).min(along).min(length - along)
            }
        };
        reach >= radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    #[test]
    fn balls_are_inside_until_they_touch_a_face() {
        let square = Region::<D2>::Box { low: DVec2::ZERO, high: DVec2::new(4.0, 2.0) };
        assert!(square.holds(DVec2::new(1.0, 1.0), 1.0) && !square.holds(DVec2::new(0.9, 1.0), 1.0));
        let slope = Region::<D2>::HalfSpace { point: DVec2::ZERO, normal: DVec2::new(0.6, 0.8) };
        assert!(slope.holds(DVec2::new(1.0, 1.0), 1.39) && !slope.holds(DVec2::new(1.0, 1.0), 1.41));
        let (from, axis) = (DVec3::new(1.0, 1.0, 0.0), DVec3::Z);
        let tube = Region::<D3>::Cylinder { from, axis, length: 3.0, radius: 2.0 };
        assert!(tube.holds(DVec3::new(2.0, 1.0, 1.0), 1.0) && !tube.holds(DVec3::new(2.0, 1.5, 1.0), 1.0));
        assert!(!tube.holds(DVec3::new(1.0, 1.0, 0.5), 1.0) && !tube.holds(DVec3::new(1.0, 1.0, 2.1), 1.0));
    }
}
