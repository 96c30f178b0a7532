//! Scenes whose grains fall for ever: told before the run, ended while it runs.

use crate::scene::{Change, Scene};
use granular_core::{Dim, Linear, Vector};
use granular_dem::{Dem, Falling, Gates};

/// What a check says of grains with nothing below them; nothing where something catches all grains, or takes them out.
pub(super) fn warnings<D: Dim>(scene: &Scene, dem: &Dem<D>) -> Vec<String> {
    if dem.has_outlets() {
        return Vec::new();
    }
    let at_start = ("gravity".to_owned(), dem.gravity());
    let later = scene.stages.iter().enumerate().flat_map(|(k, stage)| {
        stage.changes.iter().enumerate().filter_map(move |(c, change)| match change {
            Change::Gravity(values) => {
                let values: Vec<f64> = values.iter().map(|value| value.value()).collect();
                Some((format!("stages.{k}.changes.{c}"), D::Vec::from_slice(&values)?))
            }
            _ => None,
        })
    });
    let all = std::iter::once(at_start).chain(later);
    all.filter_map(|(path, gravity)| {
        let Falling { down, grains, .. } = dem.falling(gravity, Gates::Shut).filter(|fall| fall.grains > 0)?;
        let of = dem.len();
        let gravity = &gravity.padded()[..D::N];
        let fix = if down.component(D::UP) > 0.5 {
            "gravity points up, and the lowest wall is above the grains: give it a minus sign".to_owned()
        } else {
            "add a wall below them, such as Floor, or an outlet that takes them out".to_owned()
        };
        Some(format!("`{path}`: under {gravity:?} m/s^2 nothing lies below {grains} of {of} grains, which fall for ever; {fix}"))
    })
    .collect()
}

/// A box.
pub(super) type Region<D> = (<D as Dim>::Vec, <D as Dim>::Vec);

/// The region of walls and grains as they are now, to be told later whether all grains have left it. None without walls:
/// then there is nothing to leave.
pub(super) fn region<D: Dim>(dem: &Dem<D>) -> Option<Region<D>> {
    dem.bounds().filter(|_| !dem.walls().is_empty())
}

/// Whether grains may ever leave the region for good, with walls and gravity as they are now.
pub(super) fn may_be_left<D: Dim>(dem: &Dem<D>) -> bool {
    dem.gravity() != D::Vec::ZERO && !dem.has_outlets() && !dem.catches_all(dem.gravity(), Gates::AsTheyAre)
}

/// Why a run need not go on: all grains are farther below the region than it is large, and nothing lies below them.
pub(super) fn why_left<D: Dim>(dem: &Dem<D>, (low, high): Region<D>) -> Option<String> {
    if dem.brings_grains() {
        return None;
    }
    let fall = dem.falling(dem.gravity(), Gates::AsTheyAre)?;
    // Of the corners of a box the deepest takes the deeper end along each axis.
    let lowest: f64 = (0..D::N)
        .map(|axis| {
            let down = fall.down.component(axis);
            (low.component(axis) * down).max(high.component(axis) * down)
        })
        .sum();
    let (below, size) = (fall.highest - lowest, (high - low).length());
    (below > size && fall.grains == dem.len()).then(|| {
        let count = dem.len();
        format!("all {count} grains have left the walls: nothing lies below them, and the highest is {below:.4} m below the lowest point of walls and sample")
    })
}
