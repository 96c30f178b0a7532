//! What a snapshot holds of a cell.

use super::{CellControl, Control, Matrix, PeriodicCell};
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Section, SnapshotError};

impl<D: Dim> PeriodicCell<D> {
    pub(crate) fn save(&self, to: &mut Section) {
        for (name, matrix) in [
            ("cell edges", &self.edges),
            ("cell gradient", &self.gradient),
            ("cell gradient of the last step", &self.last_gradient),
            ("cell strain", &self.strain),
        ] {
            to.put(name, &matrix.to_array());
        }
        to.put("cell work and drift", &[self.work, self.drift]);
        let flat = self.control.component.iter().flatten();
        let kinds: Vec<u8> =
            flat.clone().map(|control| u8::from(matches!(control, Control::Stress(_)))).collect();
        let values: Vec<f64> = flat.map(|&(Control::Rate(value) | Control::Stress(value))| value).collect();
        to.put("cell controls", &kinds);
        to.put("cell control values", &values);
        to.put("cell response and modulus", &[self.control.response, self.control.modulus]);
    }

    pub(crate) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let matrix = |name: &str| -> Result<Matrix<D>, SnapshotError> {
            let columns: Vec<D::Vec> = from.array_of(name, 3)?;
            let matrix = Matrix { columns: [columns[0], columns[1], columns[2]] };
            check_entry(name, matrix.is_finite())?;
            Ok(matrix)
        };
        self.edges = matrix("cell edges")?;
        self.gradient = matrix("cell gradient")?;
        self.last_gradient = matrix("cell gradient of the last step")?;
        self.strain = matrix("cell strain")?;
        check_entry("cell edges", self.edges.determinant() > 0.0)?;
        let both: Vec<f64> = from.array_of("cell work and drift", 2)?;
        check_entry("cell work and drift", both.iter().all(|value| value.is_finite()))?;
        (self.work, self.drift) = (both[0], both[1]);
        let kinds: Vec<u8> = from.array_of("cell controls", 9)?;
        let values: Vec<f64> = from.array_of("cell control values", 9)?;
        check_entry("cell control values", values.iter().all(|value| value.is_finite()))?;
        let servo: Vec<f64> = from.array_of("cell response and modulus", 2)?;
        check_entry(
            "cell response and modulus",
            servo.iter().all(|value| value.is_finite() && *value >= 0.0),
        )?;
        let component = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let value = values[3 * row + column];
                if kinds[3 * row + column] == 0 { Control::Rate(value) } else { Control::Stress(value) }
            })
        });
        self.control = CellControl { component, response: servo[0], modulus: servo[1] };
        self.edge_rate = self.gradient.times(&self.edges);
        Ok(())
    }
}
