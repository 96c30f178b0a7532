//! Regular packings of equal grains.

use crate::error::{PackingError, require};
use granular_core::{Dim, Vector};

/// Part of a spacing by which round-off may shorten a box without the loss of a layer.
const ROUND_OFF: f64 = 1e-10;

/// A regular packing \[Kumar2014, section 3.5.5\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lattice {
    /// Squares in the plane (density $\pi/4$), simple cubic in space ($\pi/6$).
    Cubic,
    /// The densest: hexagonal in the plane ($\pi/(2\sqrt 3)$ = 0.90690), hexagonal close packed
    /// in space ($\pi/(3\sqrt 2)$ = 0.74048). Rows run along x and layers lie along the up axis.
    Hexagonal,
}

impl Lattice {
    /// Solid fraction of the lattice without end.
    pub fn density<D: Dim>(self) -> f64 {
        D::ball_volume(1.0) / self.spacing()[..D::N].iter().product::<f64>()
    }

    /// Centres \[m\] of all balls of `radius` \[m\] that fit into the box from `low` to `high`
    /// \[m\], from the corner `low` up: along x first, layer upon layer.
    ///
    /// Balls touch the faces at `low`; at the others a strip thinner than a layer stays empty.
    /// A box that is short of a layer by round-off (1e-10 spacings) still gets it.
    pub fn fill<D: Dim>(self, radius: f64, low: D::Vec, high: D::Vec) -> Result<Vec<D::Vec>, PackingError> {
        require(radius > 0.0 && radius.is_finite(), "radius [m]", radius, "above 0 and finite")?;
        let spacing = self.spacing().map(|factor| factor * radius);
        let mut room = [0.0; 3];
        let mut sites = 1.0;
        for axis in 0..D::N {
            let edge = (high - low).component(axis);
            let fits = edge >= 2.0 * radius * (1.0 - ROUND_OFF) && edge.is_finite();
            require(fits, "edge of the box [m]", edge, format!("at least {} (one diameter)", 2.0 * radius))?;
            room[axis] = edge - 2.0 * radius;
            sites *= layers(room[axis], spacing[axis]) as f64;
        }
        require(sites < f64::from(u32::MAX), "number of grains in the box", sites, "below 4294967295")?;
        let corner = (0..D::N).fold(low, |corner, axis| corner + D::Vec::along(axis, radius));
        let mut centres = Vec::with_capacity(sites as usize);
        for layer in 0..layers(room[2], spacing[2]) {
            let aside = self.shift_of_layer(layer) * radius;
            for row in 0..layers(room[1] - aside, spacing[1]) {
                let along = self.shift_of_row(row + layer) * radius;
                for column in 0..layers(room[0] - along, spacing[0]) {
                    let place = [
                        column as f64 * spacing[0] + along,
                        row as f64 * spacing[1] + aside,
                        layer as f64 * spacing[2],
                    ];
                    centres.push((0..D::N).fold(corner, |c, axis| c + D::Vec::along(axis, place[axis])));
                }
            }
        }
        Ok(centres)
    }

    /// Spacing along x, of rows and of layers, in radii. The plane is the first layer.
    fn spacing(self) -> [f64; 3] {
        match self {
            Self::Cubic => [2.0; 3],
            Self::Hexagonal => [2.0, 3.0_f64.sqrt(), (8.0_f64 / 3.0).sqrt()],
        }
    }

    /// Every other row lies over the gaps of the row below \[radii\].
    fn shift_of_row(self, row: usize) -> f64 {
        if self == Self::Hexagonal && row % 2 == 1 { 1.0 } else { 0.0 }
    }

    /// Every other layer lies over the hollows of the layer below \[radii\].
    fn shift_of_layer(self, layer: usize) -> f64 {
        if self == Self::Hexagonal && layer % 2 == 1 { 1.0 / 3.0_f64.sqrt() } else { 0.0 }
    }
}

/// Layers whose centres find room in a length \[m\]; one where the axis does not exist.
fn layers(room: f64, spacing: f64) -> usize {
    let steps = room / spacing + ROUND_OFF;
    if steps < 0.0 { 0 } else { steps as usize + 1 }
}

#[cfg(test)]
mod tests;
