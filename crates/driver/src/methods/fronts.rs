//! Fronts of flows: the same numbers of grains and of a continuum, so that one can be held against the other.

use super::member::Number;
use core::f64::consts::TAU;
use granular_core::{Dim, FieldSink, Vector};

/// Share of the mass behind a front that no thin layer decides.
const SHARE: f64 = 0.99;
/// Sectors about the z axis.
const SECTORS: usize = 36;

const FRONT_99: Number = Number("front_99", "m", "distance along x within which 99 % of the main mass lies");
const RADIAL_FRONT_99: Number =
    Number("radial_front_99", "m", "distance from the z axis within which 99 % of the main mass lies");
const RADIAL_FRONT: Number = Number(
    "radial_front",
    "m",
    "distance of the front of the main mass from the z axis: mean over sectors of 10 degrees; in space",
);

/// What a front is found from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<D: Dim> {
    /// Its middle \[m\].
    pub(crate) position: D::Vec,
    /// How far it reaches from there \[m\].
    pub(crate) reach: f64,
    /// Mass \[kg\].
    pub(crate) mass: f64,
    /// Whether it belongs to the main mass.
    pub(crate) is_main: bool,
}

/// Numbers that there are.
pub(crate) fn numbers<D: Dim>() -> &'static [Number] {
    const ALL: [Number; 3] = [FRONT_99, RADIAL_FRONT, RADIAL_FRONT_99];
    if D::N == 3 { &ALL } else { &ALL[..1] }
}

/// Shows what a sink wants of them; asks for `pieces` only when it wants one.
pub(crate) fn show<D: Dim>(pieces: impl FnOnce() -> Vec<Piece<D>>, sink: &mut dyn FieldSink) {
    let wanted: Vec<&Number> = numbers::<D>().iter().filter(|Number(name, ..)| sink.wants(name)).collect();
    if wanted.is_empty() {
        return;
    }
    let pieces = pieces();
    for Number(name, unit, _) in wanted {
        let value = match *name {
            "front_99" => holding(SHARE, &pieces, |at| at.component(0)),
            "radial_front_99" => holding(SHARE, &pieces, from_axis::<D>),
            _ => radial_front(&pieces),
        };
        sink.number(name, unit, value);
    }
}

fn from_axis<D: Dim>(at: D::Vec) -> f64 {
    let [x, y, _] = at.padded();
    x.hypot(y)
}

/// Distance within which a share of the main mass lies \[m\]; not a number without mass. What flew off, or rolls ahead on its own, is
/// no part of a flow.
fn holding<D: Dim>(share: f64, pieces: &[Piece<D>], distance: impl Fn(D::Vec) -> f64) -> f64 {
    let main = pieces.iter().filter(|piece| piece.is_main);
    let mut list: Vec<[f64; 2]> = main.map(|piece| [distance(piece.position), piece.mass]).collect();
    list.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let asked = share * list.iter().map(|[_, mass]| mass).sum::<f64>();
    let mut behind = 0.0;
    let found = list.iter().find(|[_, mass]| {
        behind += mass;
        behind >= asked
    });
    found.map_or(f64::NAN, |[distance, _]| *distance)
}

/// Mean over the sectors that hold pieces of the main mass of its farthest point in them \[m\].
fn radial_front<D: Dim>(pieces: &[Piece<D>]) -> f64 {
    let mut farthest = [0.0_f64; SECTORS];
    for piece in pieces.iter().filter(|piece| piece.is_main) {
        let [x, y, _] = piece.position.padded();
        let turn = y.atan2(x) / TAU + 0.5;
        let sector = &mut farthest[((turn * SECTORS as f64) as usize).min(SECTORS - 1)];
        *sector = sector.max(x.hypot(y) + piece.reach);
    }
    let met = farthest.iter().filter(|reach| **reach > 0.0);
    met.clone().sum::<f64>() / met.count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::glam::DVec3;
    use granular_core::{D3, Numbers};

    /// 200 pieces in a row along x, the last two far ahead, and some that flew off; in space also round the axis.
    #[test]
    fn a_few_pieces_ahead_do_not_make_a_front() {
        let piece = |x: f64, is_main| Piece::<D3> { position: DVec3::X * x, reach: 0.1, mass: 2.0, is_main };
        let ahead = |k: i32| if k > 198 { 300.0 } else { 0.0 };
        let row = || {
            let main = (1..=200).map(|k| piece(f64::from(k) + ahead(k), true));
            main.chain((0..20).map(|_| piece(1e3, false))).collect()
        };
        let mut found = Numbers::wanting(["front_99", "radial_front", "radial_front_99"]);
        show(row, &mut found);
        assert_eq!(found.get("front_99"), Some(198.0));
        assert_eq!(found.get("radial_front_99"), Some(198.0));
        assert_eq!(found.get("radial_front"), Some(500.1));
        show::<D3>(|| panic!("nothing is wanted"), &mut Numbers::wanting(["front"]));
    }
}
