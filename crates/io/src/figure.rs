//! Figures as SVG and PNG that need no font, library or program on the machine.
//!
//! A [`Chart`] holds series on two axes, [`Panels`] several charts, a [`GrainFigure`] snapshots of
//! disks with a colour bar, a [`MapFigure`] values in the cells of grids. Each becomes a [`Figure`], which is saved as `.svg` (text stays
//! text, which can be searched and edited, fitted to the width that it has in the bundled font) and `.png` at twice the size
//! in pixels.
//!
//! Points that are not finite, or not positive on a logarithmic axis, are left out and break a
//! line; no data makes a figure fail. In labels, superscripts and subscripts in Unicode (`10⁻⁶`,
//! `m s⁻²`, `k₁`), Greek letters and arrows are drawn.
//!
//! The font is Open Sans (Apache License 2.0, see `fonts/README.md` of this crate).

mod chart;
mod colour;
mod colour_bar;
mod drawing;
mod font;
mod geometry;
mod grains;
mod image;
mod layout;
mod legend;
mod map;
mod panels;
mod plot;
mod raster;
mod scale;
mod svg;

pub use chart::{Axis, Chart, Scale, Series, Style};
pub use grains::{Chain, Grain, GrainFigure, GrainPanel, Mark, Patch};
pub use map::{MapDisk, MapFigure, MapPanel};
pub use panels::Panels;

use crate::atomic::write_atomically;
use crate::error::IoError;
use drawing::Drawing;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A figure, ready to be saved.
#[derive(Clone, Debug)]
pub struct Figure {
    drawing: Drawing,
}

impl Figure {
    /// Width and height in CSS pixels; the PNG has twice as many.
    pub fn size(&self) -> [f64; 2] {
        self.drawing.size
    }

    /// The figure as a self-contained SVG document.
    pub fn svg(&self) -> String {
        svg::document(&self.drawing)
    }

    /// The figure as the bytes of a PNG file.
    pub fn png(&self) -> Vec<u8> {
        raster::png(&self.drawing)
    }

    /// Writes `<path>.svg` and `<path>.png` and returns both paths.
    ///
    /// # Errors
    /// When a file cannot be written; an old file of its path stays.
    pub fn save(&self, path: &Path) -> Result<[PathBuf; 2], IoError> {
        let with = |ending: &str| {
            let mut name: OsString = path.as_os_str().to_owned();
            name.push(ending);
            PathBuf::from(name)
        };
        let (svg, png) = (with(".svg"), with(".png"));
        write_atomically(&svg, |to| to.write_all(self.svg().as_bytes()))?;
        write_atomically(&png, |to| to.write_all(&self.png()))?;
        Ok([svg, png])
    }
}

#[cfg(test)]
mod tests;
