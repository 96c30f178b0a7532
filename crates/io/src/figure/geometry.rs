//! Cutting lines and polygons at the edges of a plot.

use super::drawing::{Area, Spot};

/// The part of a line between two spots that lies in an area (Liang and Barsky).
pub(super) fn clip_line(area: &Area, a: Spot, b: Spot) -> Option<[Spot; 2]> {
    let delta = [b[0] - a[0], b[1] - a[1]];
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let sides = [
        (-delta[0], a[0] - area.left),
        (delta[0], area.right - a[0]),
        (-delta[1], a[1] - area.top),
        (delta[1], area.bottom - a[1]),
    ];
    for (speed, distance) in sides {
        if speed == 0.0 {
            if distance < 0.0 {
                return None;
            }
        } else if speed < 0.0 {
            enter = enter.max(distance / speed);
        } else {
            leave = leave.min(distance / speed);
        }
    }
    let at = |t: f64| [a[0] + t * delta[0], a[1] + t * delta[1]];
    (enter <= leave).then(|| [at(enter), at(leave)])
}

/// The pieces of a line through many spots that lie in an area. Spots that would move the line by
/// less than a quarter of a pixel are dropped.
pub(super) fn clip_polyline(area: &Area, spots: &[Spot]) -> Vec<Vec<Spot>> {
    let mut pieces: Vec<Vec<Spot>> = Vec::new();
    for pair in spots.windows(2) {
        let Some([from, to]) = clip_line(area, pair[0], pair[1]) else { continue };
        let goes_on = pieces.last().and_then(|piece| piece.last()).is_some_and(|last| near(*last, from));
        match pieces.last_mut() {
            Some(piece) if goes_on => {
                if !piece.last().is_some_and(|last| near(*last, to)) {
                    piece.push(to);
                }
            }
            _ => pieces.push(vec![from, to]),
        }
    }
    pieces
}

fn near(a: Spot, b: Spot) -> bool {
    (a[0] - b[0]).abs() < 0.25 && (a[1] - b[1]).abs() < 0.25
}

/// The part of a polygon that lies in an area (Sutherland and Hodgman).
pub(super) fn clip_polygon(area: &Area, spots: &[Spot]) -> Vec<Spot> {
    let sides = [(0, 1.0, area.left), (0, -1.0, -area.right), (1, 1.0, area.top), (1, -1.0, -area.bottom)];
    let mut kept = spots.to_vec();
    for (axis, sign, bound) in sides {
        let depth = |spot: &Spot| sign * spot[axis] - bound;
        let mut next = Vec::with_capacity(kept.len() + 4);
        for (i, b) in kept.iter().enumerate() {
            let a = &kept[(i + kept.len() - 1) % kept.len()];
            let (da, db) = (depth(a), depth(b));
            if (da < 0.0) != (db < 0.0) {
                let t = da / (da - db);
                next.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
            }
            if db >= 0.0 {
                next.push(*b);
            }
        }
        kept = next;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Area = Area { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

    #[test]
    fn lines_end_at_the_edge() {
        assert_eq!(clip_line(&AREA, [-5.0, 5.0], [5.0, 5.0]), Some([[0.0, 5.0], [5.0, 5.0]]));
        assert_eq!(clip_line(&AREA, [-5.0, -1.0], [5.0, -1.0]), None);
        let pieces = clip_polyline(&AREA, &[[1.0, 1.0], [1.0, 20.0], [5.0, 20.0], [5.0, 1.0], [5.1, 1.0]]);
        assert_eq!(pieces, [[[1.0, 1.0], [1.0, 10.0]], [[5.0, 10.0], [5.0, 1.0]]]);
    }

    #[test]
    fn polygons_are_cut() {
        let cut = clip_polygon(&AREA, &[[-5.0, 2.0], [15.0, 2.0], [15.0, 4.0], [-5.0, 4.0]]);
        assert_eq!(cut.len(), 4);
        assert!(cut.iter().all(|spot| AREA.contains(*spot)));
        assert!(clip_polygon(&AREA, &[[20.0, 20.0], [30.0, 20.0], [30.0, 30.0]]).is_empty());
        assert!(clip_polygon(&AREA, &[]).is_empty());
    }
}
