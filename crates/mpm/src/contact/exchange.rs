//! What two bodies that meet at a node exchange.

use granular_core::blocks::Divide;
use granular_core::{Dim, Linear};

/// Two fields in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    /// The lower one first.
    pub(crate) fields: [usize; 2],
    pub(crate) friction: f64,
}

/// What pairs of fields do.
#[derive(Clone, Debug, Default)]
pub(super) struct Rules {
    pairs: Vec<Pair>,
}

impl Rules {
    pub(super) fn new(pairs: Vec<Pair>) -> Self {
        Self { pairs }
    }

    /// Where two fields book what they exchange, and their friction; none where they stick, which has the last place.
    pub(super) fn of(&self, one: usize, other: usize) -> (usize, Option<f64>) {
        let found = self.pairs.iter().position(|pair| pair.fields == [one, other]);
        found.map_or((self.pairs.len(), None), |place| (place, Some(self.pairs[place].friction)))
    }
}

/// What was exchanged on a block by one contact in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Exchanged<D: Dim> {
    /// Momentum that the second body got \[N s\].
    pub(crate) impulse: D::Vec,
    /// Energy lost \[J\]: to friction, and to stopping what approaches.
    pub(crate) lost: [f64; 2],
}

/// As many items for every block.
pub(super) struct Chunks<'a, T> {
    pub(super) items: &'a mut [T],
    pub(super) each: usize,
}

impl<T: Send> Divide for Chunks<'_, T> {
    fn divide(self, blocks: usize, _: usize) -> (Self, Self) {
        let (left, right) = self.items.split_at_mut((blocks * self.each).min(self.items.len()));
        (Self { items: left, each: self.each }, Self { items: right, each: self.each })
    }
}

/// How a pair meets at a node in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meets {
    /// Not, or no longer.
    Apart,
    /// One slides along the other.
    Slides,
    /// Both move alike.
    Sticks,
}

/// Momentum that one gives to another which it approaches along a unit normal with a velocity: along the normal and across it, for a
/// reduced mass; friction is none where they stick whatever they do.
pub(super) fn given<D: Dim>(
    approach: D::Vec,
    normal: D::Vec,
    reduced_mass: f64,
    friction: Option<f64>,
) -> ([D::Vec; 2], Meets) {
    let Some(friction) = friction else { return ([D::Vec::ZERO, approach * reduced_mass], Meets::Sticks) };
    let speed = approach.dot(normal);
    if speed <= 0.0 {
        return ([D::Vec::ZERO; 2], Meets::Apart);
    }
    let across = approach - normal * speed;
    let (slip, most) = (across.length(), friction * speed);
    let pressing = normal * (speed * reduced_mass);
    if slip <= most {
        return ([across * reduced_mass, pressing], Meets::Sticks);
    }
    ([across * (most / slip * reduced_mass), pressing], Meets::Slides)
}

/// Power of the length of a gradient by which it counts.
const FLATNESS: i32 = 32;

/// Unit normal from one body to another, by what the gradients of their volumes say: each points out of its body, and is as long as the
/// surface near the node is large. Zero where nothing says.
pub(super) fn normal_between<D: Dim>(one: D::Vec, other: D::Vec) -> D::Vec {
    let lengths = [one.length(), other.length()];
    let largest = lengths[0].max(lengths[1]);
    if largest == 0.0 {
        return D::Vec::ZERO;
    }
    let share = lengths.map(|length| (length / largest).powi(FLATNESS));
    let sum = one * share[0] - other * share[1];
    let length = sum.length();
    if length > 0.0 { sum * (1.0 / length) } else { D::Vec::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D2;
    use granular_core::glam::DVec2;

    #[test]
    fn coulomb_friction_is_capped_by_what_presses() {
        let approach = DVec2::new(3.0, -2.0);
        let given = |friction| given::<D2>(approach, -DVec2::Y, 0.5, friction);
        assert_eq!(given(Some(0.5)), ([DVec2::new(0.5, 0.0), DVec2::new(0.0, -1.0)], Meets::Slides));
        assert_eq!(given(Some(1.5)), ([DVec2::new(1.5, 0.0), DVec2::new(0.0, -1.0)], Meets::Sticks));
        assert_eq!(given(None), ([DVec2::ZERO, approach * 0.5], Meets::Sticks));
        let parting = super::given::<D2>(approach, DVec2::Y, 0.5, Some(0.5));
        assert_eq!(parting, ([DVec2::ZERO; 2], Meets::Apart));
    }

    #[test]
    fn a_corner_on_a_flat_side_has_the_normal_of_the_side() {
        // A quarter of the plane on a half of it.
        let normal = normal_between::<D2>(DVec2::new(0.5, -0.5), DVec2::new(0.0, 1.0));
        assert!((normal + DVec2::Y).length() < 0.04, "{normal}");
        assert_eq!(normal_between::<D2>(DVec2::new(0.0, 2.0), DVec2::new(0.0, -1.0)), DVec2::Y);
        assert_eq!(normal_between::<D2>(DVec2::ZERO, DVec2::ZERO), DVec2::ZERO);
    }
}
