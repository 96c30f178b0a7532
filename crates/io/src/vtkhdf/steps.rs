//! What both kinds of file share: opening, times, numbers, the count of steps, field arrays.

use super::dataset::{append, append_values, for_field, growing, put_unit, truncate};
use crate::frame::{Field, Frame, Number, Values};
use hdf5::types::FixedAscii;
use hdf5::{Attribute, Dataset, File, Group, Result};
use std::path::Path;

/// Steps in a chunk of the arrays with one row a step.
pub(super) const STEPS: usize = 256;

/// An open file.
#[derive(Debug)]
pub(super) struct Steps {
    pub(super) file: File,
    pub(super) root: Group,
    pub(super) group: Group,
    count: Attribute,
    times: Dataset,
    done: usize,
    /// Whether a step was begun and not ended: its rows are then out of line.
    open: bool,
}

impl Steps {
    /// Starts a file whose type name has exactly `N` letters.
    pub(super) fn create<const N: usize>(path: &Path, kind: &[u8; N]) -> Result<Self> {
        let file = File::create(path)?;
        let root = file.create_group("VTKHDF")?;
        root.new_attr_builder().with_data(&[2_i64, 2]).create("Version")?;
        let kind = FixedAscii::<N>::from_ascii(kind).map_err(|error| error.to_string())?;
        root.new_attr::<FixedAscii<N>>().create("Type")?.write_scalar(&kind)?;
        let group = root.create_group("Steps")?;
        let count = group.new_attr::<i64>().create("NSteps")?;
        count.write_scalar(&0_i64)?;
        let times = growing::<f64>(&group, "Values", &[], STEPS)?;
        Ok(Self { file, root, group, count, times, done: 0, open: false })
    }

    /// Opens a file and drops the steps from `steps` on; the arrays are still to be cut.
    pub(super) fn reopen(path: &Path, steps: usize) -> Result<Self> {
        let file = File::open_rw(path)?;
        let root = file.group("VTKHDF")?;
        let group = root.group("Steps")?;
        let count = group.attr("NSteps")?;
        let found: i64 = count.read_scalar()?;
        if found < steps as i64 {
            return Err(format!("it has {found} steps where {steps} are expected").into());
        }
        // First the count: from here on what is cut does not count.
        count.write_scalar(&(steps as i64))?;
        file.flush()?;
        let times = group.dataset("Values")?;
        truncate(&times, steps)?;
        Ok(Self { file, root, group, count, times, done: steps, open: false })
    }

    pub(super) fn done(&self) -> usize {
        self.done
    }

    /// Begins a step.
    pub(super) fn begin(&mut self) -> Result<()> {
        if self.open {
            return Err("an earlier frame failed half-way; the file must be reopened first".into());
        }
        self.open = true;
        Ok(())
    }

    /// Ends a step: all that was appended since the last one counts from here on.
    pub(super) fn commit(&mut self, time: f64) -> Result<()> {
        append(&self.times, &[time])?;
        // The arrays reach the file before the count that makes them valid.
        self.file.flush()?;
        self.count.write_scalar(&(self.done as i64 + 1))?;
        self.file.flush()?;
        self.done += 1;
        self.open = false;
        Ok(())
    }
}

/// Field arrays of a group with the row at which each step starts.
#[derive(Debug)]
pub(super) struct FieldArrays {
    arrays: Vec<(String, Dataset, Dataset)>,
}

impl FieldArrays {
    /// Arrays for these fields in the group `data` of the root and `offsets` of the steps.
    pub(super) fn create(
        steps: &Steps,
        [data, offsets]: [&str; 2],
        fields: &[Field],
        places: &[usize],
        rows: usize,
    ) -> Result<Self> {
        let (data, offsets) = (steps.root.create_group(data)?, steps.group.create_group(offsets)?);
        let arrays = fields.iter().map(|field| {
            let values = for_field(&data, field, places, rows)?;
            Ok((field.name.clone(), values, growing::<i64>(&offsets, &field.name, &[], STEPS)?))
        });
        Ok(Self { arrays: arrays.collect::<Result<_>>()? })
    }

    /// The arrays of a file that is taken up again, cut to `rows` rows.
    pub(super) fn reopen(steps: &Steps, [data, offsets]: [&str; 2], rows: usize) -> Result<Self> {
        let (data, offsets) = (steps.root.group(data)?, steps.group.group(offsets)?);
        let arrays = data.member_names()?.into_iter().map(|name| {
            let (values, starts) = (data.dataset(&name)?, offsets.dataset(&name)?);
            truncate(&values, rows)?;
            truncate(&starts, steps.done())?;
            Ok((name, values, starts))
        });
        Ok(Self { arrays: arrays.collect::<Result<_>>()? })
    }

    /// Appends the fields of a step whose values start at row `start`.
    pub(super) fn append(&self, fields: &[Field], start: i64) -> Result<()> {
        for (name, values, starts) in &self.arrays {
            let field = fields.iter().find(|field| field.name == *name).expect("the names are checked");
            append_values(values, &field.values)?;
            append(starts, &[start])?;
        }
        Ok(())
    }

    /// Checks that a frame has the same fields as the first, of the same kind.
    pub(super) fn check(&self, fields: &[Field]) -> Result<()> {
        let listed = |names: Vec<&str>| names.join(", ");
        let mut have: Vec<&str> = self.arrays.iter().map(|(name, ..)| name.as_str()).collect();
        let mut given: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
        have.sort_unstable();
        given.sort_unstable();
        if have != given {
            let (have, given) = (listed(have), listed(given));
            return Err(format!("the file has fields {have}; this frame has {given}").into());
        }
        for (name, values, _) in &self.arrays {
            let field = fields.iter().find(|field| field.name == *name).expect("the names are the same");
            if !same_kind(field, values) {
                return Err(format!("field `{name}` has changed its kind").into());
            }
        }
        Ok(())
    }
}

/// Whether the values of a field fit the last axis and the type of a dataset.
fn same_kind(field: &Field, dataset: &Dataset) -> bool {
    let same_type = match field.values {
        Values::Single(_) => dataset.dtype().is_ok_and(|kind| kind.is::<f32>()),
        Values::Index(_) => dataset.dtype().is_ok_and(|kind| kind.is::<u32>()),
        _ => dataset.dtype().is_ok_and(|kind| kind.is::<f64>()),
    };
    let components = field.values.components();
    same_type && (components == 1 || dataset.shape().last() == Some(&components))
}

/// The numbers of the frames, one row a step.
#[derive(Debug)]
pub(super) struct NumberArrays {
    arrays: Vec<(String, Dataset, Dataset, Dataset)>,
}

const NUMBERS: [&str; 3] = ["FieldData", "FieldDataOffsets", "FieldDataSizes"];

impl NumberArrays {
    pub(super) fn create(steps: &Steps, numbers: &[Number]) -> Result<Self> {
        let [data, offsets, sizes] = NUMBERS;
        let data = steps.root.create_group(data)?;
        let (offsets, sizes) = (steps.group.create_group(offsets)?, steps.group.create_group(sizes)?);
        let arrays = numbers.iter().map(|number| {
            let values = growing::<f64>(&data, &number.name, &[], STEPS)?;
            put_unit(&values, &number.unit)?;
            let starts = growing::<i64>(&offsets, &number.name, &[], STEPS)?;
            let sizes = growing::<i64>(&sizes, &number.name, &[2], STEPS)?;
            Ok((number.name.clone(), values, starts, sizes))
        });
        Ok(Self { arrays: arrays.collect::<Result<_>>()? })
    }

    pub(super) fn reopen(steps: &Steps) -> Result<Self> {
        let [data, offsets, sizes] = NUMBERS;
        let data = steps.root.group(data)?;
        let (offsets, sizes) = (steps.group.group(offsets)?, steps.group.group(sizes)?);
        let arrays = data.member_names()?.into_iter().map(|name| {
            let (values, starts) = (data.dataset(&name)?, offsets.dataset(&name)?);
            let sizes = sizes.dataset(&name)?;
            for dataset in [&values, &starts, &sizes] {
                truncate(dataset, steps.done())?;
            }
            Ok((name, values, starts, sizes))
        });
        Ok(Self { arrays: arrays.collect::<Result<_>>()? })
    }

    /// A number that a frame lacks is NaN there; one that is new is not kept.
    pub(super) fn append(&self, frame: &Frame) -> Result<()> {
        for (name, values, starts, sizes) in &self.arrays {
            let number = frame.numbers().iter().find(|number| number.name == *name);
            let start = append(values, &[number.map_or(f64::NAN, |number| number.value)])?;
            append(starts, &[start])?;
            append(sizes, &[1_i64, 1])?;
        }
        Ok(())
    }
}
