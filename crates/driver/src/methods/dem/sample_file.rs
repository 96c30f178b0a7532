//! Samples in files: grains that one scene prepared and others start from.
//!
//! A table as `pandas.read_csv(path, comment="#")` reads it: place, radius, velocity and spin of each grain in SI units, and the
//! name of its material. Lines in front say the dimension, the size of the column if it is one, and a checksum of
//! all that follows; a file made by hand may leave the checksum out. Forces are not kept: where grains
//! overlap, contacts push at once, and friction builds up anew, so that a sample needs a short stage to rest.

use crate::column::{ColumnSize, Round};
use crate::failure::Failure;
use crate::machine;
use granular_core::{Dim, Spin, Vector};
use granular_dem::{Dem, Grain, MaterialId};
use granular_io::{CsvRow, csv_row, csv_rows, write_atomically};
use std::fmt::Write as _;
use std::path::Path;

/// Memory that a byte of a file takes, grains made of it included \[bytes\].
const BYTES_PER_BYTE: f64 = 10.0;
const FIRST_LINE: &str = "# granular sample 1";

/// Grains with names of their materials.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SavedSample<D: Dim> {
    pub(crate) grains: Vec<Grain<D>>,
    /// Names that `MaterialId`s of `grains` count.
    pub(crate) materials: Vec<String>,
    pub(crate) column: Option<ColumnSize>,
}

/// What is wrong with a file, and in which line of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct BadSample {
    pub(crate) value: String,
    pub(crate) allowed: String,
}

fn bad(value: impl Into<String>, allowed: impl Into<String>) -> BadSample {
    BadSample { value: value.into(), allowed: allowed.into() }
}

impl<D: Dim> SavedSample<D> {
    /// The grains of a solver, in the order of their identifiers.
    pub(crate) fn of(dem: &Dem<D>, materials: Vec<String>, column: Option<ColumnSize>) -> Self {
        let mut grains: Vec<(u32, Grain<D>)> = dem.grains().collect();
        grains.sort_unstable_by_key(|(id, _)| *id);
        let column = column.map(|column| ColumnSize { height: dem.reach(D::UP), ..column });
        Self { grains: grains.into_iter().map(|(_, grain)| grain).collect(), materials, column }
    }

    fn dimension() -> &'static str {
        if D::AXES.len() == 3 { "space" } else { "plane" }
    }

    fn head() -> Vec<String> {
        let axes = |name: &str, unit: &str| {
            D::AXES.iter().map(|axis| format!("{name}{axis} [{unit}]")).collect::<Vec<_>>()
        };
        let spin = match D::AXES.len() {
            2 => vec!["spin [rad/s]".to_owned()],
            _ => axes("spin_", "rad/s"),
        };
        let radius = vec!["radius [m]".to_owned()];
        [axes("", "m"), radius, axes("velocity_", "m/s"), spin, vec!["material".to_owned()]].concat()
    }

    /// The text of the file.
    pub(crate) fn text(&self) -> String {
        let mut body = format!("# {}\n", Self::dimension());
        if let Some(ColumnSize { width, height, depth, round }) = self.column {
            let depth = depth.map_or(String::new(), |depth| format!(" depth {depth}"));
            let _ = match round {
                None => writeln!(body, "# column width {width} height {height}{depth}"),
                Some(Round::Whole) => writeln!(body, "# cylinder radius {width} height {height}"),
                Some(Round::Half) => writeln!(body, "# half cylinder radius {width} height {height}"),
            };
        }
        body += &csv_row(Self::head());
        for grain in &self.grains {
            let spin = grain.spin.components();
            let spin = if D::AXES.len() == 2 { &spin[2..] } else { &spin[..] };
            let vector = |v: D::Vec| (0..D::N).map(|axis| v.component(axis)).collect::<Vec<f64>>();
            let numbers =
                [&vector(grain.position)[..], &[grain.radius], &vector(grain.velocity), spin].concat();
            let material = self.materials[grain.material.index()].clone();
            body += &csv_row(numbers.iter().map(|number| format!("{number:?}")).chain([material]));
        }
        format!("{FIRST_LINE}, checksum {:016x}\n{body}", xxhash_rust::xxh3::xxh3_64(body.as_bytes()))
    }

    /// Writes the file.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Failure> {
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
        }
        write_atomically(path, |file| file.write_all(self.text().as_bytes()))?;
        Ok(())
    }

    /// Reads a file.
    pub(crate) fn read(path: &Path) -> Result<Self, BadSample> {
        let shown = path.display();
        let unreadable = |reason: String| {
            bad(format!("`{shown}`, which cannot be read: {reason}"), "a file that a stage saved")
        };
        machine::readable(path, BYTES_PER_BYTE).map_err(unreadable)?;
        let text = std::fs::read_to_string(path).map_err(|error| unreadable(error.to_string()))?;
        Self::parse(&text).map_err(|BadSample { value, allowed }| bad(format!("`{shown}`: {value}"), allowed))
    }

    fn parse(text: &str) -> Result<Self, BadSample> {
        let (first, body) = text.split_once('\n').unwrap_or((text, ""));
        let rest = first.trim_end().strip_prefix(FIRST_LINE);
        let rest = rest.ok_or_else(|| bad("no sample", format!("a file that begins with `{FIRST_LINE}`")))?;
        if let Some(sum) = rest.strip_prefix(", checksum ") {
            let found = format!("{:016x}", xxhash_rust::xxh3::xxh3_64(body.as_bytes()));
            if sum != found {
                let hint = "what was saved; leave the checksum out if it was changed on purpose";
                return Err(bad(format!("damaged: its checksum is {found}, not {sum}"), hint));
            }
        }
        let mut sample = Self { grains: Vec::new(), materials: Vec::new(), column: None };
        let mut dimension = false;
        for (k, line) in body.lines().enumerate() {
            let Some(comment) = line.strip_prefix('#') else { continue };
            let place = |what: &str| format!("line {}: {what}", k + 2);
            match comment.trim() {
                known @ ("plane" | "space") if known == Self::dimension() => dimension = true,
                other @ ("plane" | "space") => {
                    return Err(bad(place(&format!("grains in the {other}")), Self::dimension()));
                }
                other if SIZES.iter().any(|(begin, ..)| other.starts_with(begin)) => {
                    sample.column = Some(column(other, &place)?);
                }
                _ => {}
            }
        }
        let mut rows = csv_rows(body);
        if let Some(head) = rows.next().filter(|head| head.fields().ne(Self::head())) {
            return Err(bad(told(&head), format!("`{}`", Self::head().join(","))));
        }
        for row in rows {
            sample.push(&row)?;
        }
        match (dimension, sample.grains.is_empty()) {
            (false, _) => Err(bad("no line with the dimension", format!("`# {}`", Self::dimension()))),
            (_, true) => Err(bad("no grains", "at least one grain")),
            _ => Ok(sample),
        }
    }

    /// Reads the row of a grain.
    fn push(&mut self, row: &CsvRow) -> Result<(), BadSample> {
        let count = Self::head().len() - 1;
        let wanted = || bad(told(row), format!("{count} finite numbers and the name of a material"));
        let mut fields = row.fields();
        let material = fields.next_back().unwrap_or_default();
        let values: Result<Vec<f64>, _> = fields.map(str::parse::<f64>).collect();
        let values =
            values.ok().filter(|values| values.len() == count && values.iter().all(|v| v.is_finite()));
        let values = values.ok_or_else(wanted)?;
        let (position, rest) = values.split_at(D::N);
        let (radius, rest) = (rest[0], &rest[1..]);
        let (velocity, spin) = rest.split_at(D::N);
        if radius <= 0.0 {
            return Err(bad(format!("line {}: a radius of {radius} m", line(row)), "above 0"));
        }
        let known = self.materials.iter().position(|name| name == material);
        let id = known.unwrap_or(self.materials.len());
        if known.is_none() {
            self.materials.push(material.to_owned());
        }
        let id = u8::try_from(id)
            .map_err(|_| bad(format!("line {}: too many materials", line(row)), "at most 256"))?;
        let vector = |values: &[f64]| D::Vec::from_slice(values).expect("one number per axis was counted");
        let spin = if let [z] = spin {
            D::Spin::about_z(*z)
        } else {
            D::Spin::of_components([spin[0], spin[1], spin[2]])
        };
        let grain = Grain::at(vector(position), radius, MaterialId::of_index(id))
            .moving(vector(velocity))
            .turning(spin);
        self.grains.push(grain);
        Ok(())
    }
}

/// The line of a row in the file, whose first one is not part of the table.
fn line(row: &CsvRow) -> usize {
    row.line() + 1
}

/// A row as an error shows it.
fn told(row: &CsvRow) -> String {
    format!("line {}: `{}`", line(row), row.fields().collect::<Vec<_>>().join(","))
}

/// How a line with a size begins, the name of the width, and what it is.
const SIZES: [(&str, &str, Option<Round>); 3] = [
    ("column ", "width", None),
    ("cylinder ", "radius", Some(Round::Whole)),
    ("half cylinder ", "radius", Some(Round::Half)),
];

/// Reads `column width 0.05 height 0.04`, with a depth in space, or `cylinder radius 0.05 height 0.04`.
fn column(text: &str, place: &dyn Fn(&str) -> String) -> Result<ColumnSize, BadSample> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let number = |name: &str| {
        let at = words.iter().position(|word| *word == name)?;
        words.get(at + 1)?.parse().ok().filter(|value: &f64| *value > 0.0 && value.is_finite())
    };
    let kind = SIZES.iter().find(|(begin, ..)| text.starts_with(begin));
    let size = kind.and_then(|&(_, width, round)| {
        let (width, height) = (number(width)?, number("height")?);
        Some(ColumnSize { width, height, depth: number("depth"), round })
    });
    let allowed = "`# column width W height H` or `# cylinder radius R height H`, both above 0";
    size.ok_or_else(|| bad(place(&format!("`{text}`")), allowed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D2;
    use granular_core::glam::DVec2;

    fn sample() -> SavedSample<D2> {
        let grain = |x: f64, id| {
            Grain::at(DVec2::new(x, 0.1 + 0.2), 1e-3 / 3.0, MaterialId::of_index(id)).turning(-0.1 * x)
        };
        SavedSample {
            grains: vec![grain(0.1, 0), grain(1e-300, 1)],
            materials: vec!["glass".to_owned(), "steel".to_owned()],
            column: Some(ColumnSize { width: 0.3, height: 1.0 / 3.0, depth: None, round: None }),
        }
    }

    #[test]
    fn a_sample_comes_back_to_the_same_bits() {
        assert_eq!(SavedSample::parse(&sample().text()), Ok(sample()));
        for round in [Round::Whole, Round::Half] {
            let size = ColumnSize { width: 0.1, height: 0.7, depth: None, round: Some(round) };
            let cylinder = SavedSample { column: Some(size), ..sample() };
            assert_eq!(SavedSample::parse(&cylinder.text()), Ok(cylinder));
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let text = sample().text();
        let without_sum = text.replacen(&text[..text.find('\n').unwrap()], FIRST_LINE, 1);
        assert_eq!(SavedSample::<D2>::parse(&without_sum), Ok(sample()));
        let said = |text: &str| SavedSample::<D2>::parse(text).unwrap_err().value;
        assert!(said(&text.replace("steel", "stool")).starts_with("damaged"));
        assert!(said("x,y").starts_with("no sample"));
        assert_eq!(said(&without_sum.replace("plane", "space")), "line 2: grains in the space");
        assert!(said(&without_sum.replace(",glass", ",,glass")).starts_with("line 5: `0.1,"));
        assert!(said(&without_sum.replace("width 0.3", "width -1")).starts_with("line 3: `column"));
        assert!(said(&without_sum.replace("radius [m]", "radius [mm]")).starts_with("line 4: `x [m]"));
        assert!(said(&without_sum.replace(",glass", ",-glass,steel")).starts_with("line 5: `0.1,"));
        assert_eq!(
            said(&without_sum.replace("0.1,0.30000000000000004,0.000", "0.1,0.3,-0.000")),
            "line 5: a radius of -0.0003333333333333333 m"
        );
        assert_eq!(said(&format!("{FIRST_LINE}\n# plane\n")), "no grains");
    }

    /// Files that were saved before are read with their checksum, and saved again to the same bytes.
    #[test]
    fn the_text_of_a_sample_does_not_change() {
        let expected = "# granular sample 1, checksum 955a6234f0aabe5e\n# plane\n# column width 0.3 height 0.3333333333333333\n\
            x [m],y [m],radius [m],velocity_x [m/s],velocity_y [m/s],spin [rad/s],material\n\
            0.1,0.30000000000000004,0.0003333333333333333,0.0,0.0,-0.010000000000000002,glass\n\
            1e-300,0.30000000000000004,0.0003333333333333333,0.0,0.0,-1e-301,steel\n";
        assert_eq!(sample().text(), expected);
    }

    #[test]
    fn a_material_may_have_a_comma_in_its_name() {
        let named =
            SavedSample { materials: vec!["glass, wet".to_owned(), "steel \"4\"".to_owned()], ..sample() };
        assert_eq!(SavedSample::parse(&named.text()), Ok(named));
    }
}
