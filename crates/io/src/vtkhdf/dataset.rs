//! Datasets that grow along their first axis.

use crate::frame::{Field, Values};
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, Error, Extent, Extents, Group, H5Type, Hyperslab, Result, SimpleExtents, SliceOrIndex};
use ndarray::ArrayViewD;

/// Values in a chunk: large enough to compress, small enough to keep in memory.
const CHUNK: usize = 1 << 20;

/// A dataset of no rows so far, each of shape `tail`, with about `rows` rows a chunk.
pub(super) fn growing<T: H5Type>(to: &Group, name: &str, tail: &[usize], rows: usize) -> Result<Dataset> {
    let mut extents = vec![Extent::resizable(0)];
    extents.extend(tail.iter().map(|&n| Extent::fixed(n)));
    let mut chunk = vec![rows];
    chunk.extend_from_slice(tail);
    while chunk.iter().product::<usize>() > CHUNK {
        let longest = chunk.iter_mut().find(|n| **n > 1).expect("a product above one has such a factor");
        *longest = longest.div_ceil(2);
    }
    let extents = Extents::Simple(SimpleExtents::new(extents));
    to.new_dataset::<T>().chunk(chunk).shuffle().deflate(4).shape(extents).create(name)
}

/// A dataset for the values of a field.
pub(super) fn for_field(to: &Group, field: &Field, places: &[usize], rows: usize) -> Result<Dataset> {
    let mut tail = places.to_vec();
    if field.values.components() > 1 {
        tail.push(field.values.components());
    }
    let dataset = match field.values {
        Values::Single(_) => growing::<f32>(to, &field.name, &tail, rows),
        Values::Index(_) => growing::<u32>(to, &field.name, &tail, rows),
        _ => growing::<f64>(to, &field.name, &tail, rows),
    }?;
    put_unit(&dataset, &field.unit)?;
    Ok(dataset)
}

/// Keeps the unit with a dataset.
pub(super) fn put_unit(dataset: &Dataset, unit: &str) -> Result<()> {
    let unit: VarLenUnicode = unit.parse().map_err(|error| Error::from(format!("unit `{unit}`: {error}")))?;
    dataset.new_attr::<VarLenUnicode>().create("unit")?.write_scalar(&unit)
}

/// Appends whole rows and returns the row where they start.
pub(super) fn append<T: H5Type>(to: &Dataset, data: &[T]) -> Result<i64> {
    let mut shape = to.shape();
    let old = shape[0];
    let rows = data.len() / shape[1..].iter().product::<usize>().max(1);
    if rows == 0 {
        return Ok(old as i64);
    }
    shape[0] = old + rows;
    to.resize(shape.clone())?;
    let mut selection: Vec<SliceOrIndex> = vec![(old..old + rows).into()];
    selection.extend(shape[1..].iter().map(|&n| SliceOrIndex::from(0..n)));
    shape[0] = rows;
    let view = ArrayViewD::from_shape(shape, data).map_err(|error| Error::from(error.to_string()))?;
    to.write_slice(view, Hyperslab::from(selection))?;
    Ok(old as i64)
}

/// Appends the values of a field.
pub(super) fn append_values(to: &Dataset, values: &Values) -> Result<()> {
    match values {
        Values::Scalar(v) => append(to, v),
        Values::Single(v) => append(to, v),
        Values::Vector(v) => append(to, v.as_flattened()),
        Values::Tensor(v) => append(to, v.as_flattened()),
        Values::Index(v) => append(to, v),
    }?;
    Ok(())
}

/// Drops all rows from `rows` on.
pub(super) fn truncate(dataset: &Dataset, rows: usize) -> Result<()> {
    let mut shape = dataset.shape();
    if shape[0] < rows {
        let (name, found) = (dataset.name(), shape[0]);
        return Err(format!("`{name}` has {found} rows where {rows} are expected").into());
    }
    shape[0] = rows;
    dataset.resize(shape)
}

/// One row of a dataset of integers.
pub(super) fn row(dataset: &Dataset, index: usize) -> Result<Vec<i64>> {
    let mut selection: Vec<SliceOrIndex> = vec![(index..index + 1).into()];
    selection.extend(dataset.shape()[1..].iter().map(|&n| SliceOrIndex::from(0..n)));
    let read = dataset.read_slice::<i64, _, ndarray::IxDyn>(Hyperslab::from(selection))?;
    Ok(read.iter().copied().collect())
}
