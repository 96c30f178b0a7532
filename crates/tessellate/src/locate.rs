//! Whether a point lies within a boundary.

use crate::cells::Side;
use granular_core::glam::DVec2;

/// Whether a point lies within closed loops of sides: a ray to the right crosses them an odd number of times. On
/// the boundary itself the answer is that of rounding.
pub fn encloses(boundary: &[Vec<Side>], point: DVec2) -> bool {
    boundary.iter().flatten().map(|side| crossings(side, point)).sum::<usize>() % 2 == 1
}

/// How often a side crosses the ray from a point to the right.
fn crossings(side: &Side, point: DVec2) -> usize {
    let above = [side.from, side.to].map(|end| end.y > point.y);
    let Some(curve) = side.curve().filter(|curve| !curve.is_straight()) else {
        if above[0] == above[1] {
            return 0;
        }
        let share = (point.y - side.from.y) / (side.to.y - side.from.y);
        return usize::from(side.from.x + share * (side.to.x - side.from.x) > point.x);
    };
    let height = curve.beyond(point, DVec2::Y);
    let [first, last] = [side.from, side.to].map(|end| curve.parameter(end));
    let within = |eta: &f64| (first.min(last)..first.max(last)).contains(eta);
    let mut ends = vec![first];
    ends.extend(height.roots().into_iter().flatten().filter(within));
    if first > last {
        ends[1..].reverse();
    }
    ends.push(last);
    // Above or not: at the begin, in the middle of each stretch, at the end. It changes at the ends of stretches.
    let middles = ends.windows(2).map(|pair| height.at(0.5 * (pair[0] + pair[1])));
    let states: Vec<bool> = [above[0]].into_iter().chain(middles).chain([above[1]]).collect();
    let changes = states.windows(2).zip(&ends).filter(|(pair, _)| pair[0] != pair[1]);
    changes.filter(|(_, eta)| curve.point(**eta).x > point.x).count()
}
