//! What a cell shows: lengths, strain, stress and density, computed when asked for.

use super::Matrix;
use crate::contact::Partner;
use crate::dem::Dem;
use granular_core::{Dim, FieldSink, Shown, ShownAs};

impl<D: Dim> Dem<D> {
    /// Stress of the cell \[Pa; N/m in the plane\], positive in compression, from contacts and from motion
    /// relative to the flow. Component `[i][j]` is `sum F_i r_j + m u_i u_j` over the volume; the two halves of
    /// shear differ only by what turns the grains. `None` unless all axes are periodic.
    pub fn cell_stress(&self) -> Option<Matrix<D>> {
        let volume = self.cell()?.volume()?;
        let mut sum = Matrix::zero();
        self.visit_contacts(&mut |contact| {
            if matches!(contact.partner, Partner::Grain(_)) {
                sum = sum.plus(&Matrix::dyad(contact.force, contact.branch), 1.0);
            }
        });
        for (&u, &mass) in self.grains.velocity.iter().zip(&self.grains.mass) {
            sum = sum.plus(&Matrix::dyad(u, u), mass);
        }
        Some(Matrix::zero().plus(&sum, 1.0 / volume))
    }

    /// Area or volume of the grains over that of the cell; overlaps count twice. `None` unless all
    /// axes are periodic.
    pub fn solid_fraction(&self) -> Option<f64> {
        let volume = self.cell()?.volume()?;
        Some(self.grains.radius.iter().map(|&radius| D::ball_volume(radius)).sum::<f64>() / volume)
    }

    /// Numbers of the cell: name, unit and meaning, in the order of [`Dem::show_cell`].
    pub(crate) fn cell_catalogue(&self) -> Vec<Shown> {
        let Some(cell) = self.cell() else { return Vec::new() };
        let mut list = Vec::new();
        let mut add = |name: String, unit, meaning| {
            list.push(Shown::new(name, unit, meaning, ShownAs::Number));
        };
        for (i, a) in D::AXES.iter().enumerate().filter(|&(i, _)| cell.is_periodic(i)) {
            for (j, b) in D::AXES.iter().enumerate().filter(|&(j, _)| cell.is_periodic(j)) {
                let meaning = if i == j {
                    "length of the cell along the axis"
                } else {
                    "tilt of the second edge along the first axis"
                };
                add(format!("cell_{a}{b}"), "m", meaning);
                add(format!("cell_rate_{a}{b}"), "1/s", "velocity gradient of the cell");
                add(
                    format!("cell_strain_{a}{b}"),
                    "1",
                    "integral of the velocity gradient of the cell over time",
                );
                if cell.is_closed() {
                    add(format!("cell_stress_{a}{b}"), "Pa", "stress of the cell, positive in compression");
                }
            }
        }
        if cell.is_closed() {
            add("solid_fraction".to_owned(), "1", "area or volume of the grains over that of the cell");
        }
        add("cell_work".to_owned(), "J", "work that the deformation of the cell did on the grains");
        list
    }

    pub(crate) fn show_cell(&self, sink: &mut dyn FieldSink) {
        let Some(cell) = self.cell() else { return };
        let mut stress = None;
        for shown in self.cell_catalogue() {
            if !sink.wants(&shown.name) {
                continue;
            }
            let value = match shown.name.as_str() {
                "solid_fraction" => self.solid_fraction().unwrap_or(f64::NAN),
                "cell_work" => cell.work,
                name => {
                    let (kind, axes) = name.rsplit_once('_').unwrap_or((name, ""));
                    let place = |k: usize| {
                        D::AXES.iter().position(|axis| axes.get(k..=k) == Some(*axis)).unwrap_or(0)
                    };
                    let of = |matrix: &Matrix<D>| matrix.at(place(0), place(1));
                    match kind {
                        "cell" => of(&cell.edges),
                        "cell_rate" => of(&cell.gradient),
                        "cell_strain" => of(&cell.strain),
                        _ => of(stress.get_or_insert_with(|| self.cell_stress().unwrap_or_default())),
                    }
                }
            };
            sink.number(&shown.name, shown.unit, value);
        }
    }
}
