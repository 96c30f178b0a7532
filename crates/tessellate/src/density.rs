//! Packing density from cells.

use std::f64::consts::PI;

/// Cells larger than this many times the mean of those inside count as free surface.
///
/// The validation case `packing_density` prints the density of a column over this number. At rest the density is the same for
/// anything from 1.75 on. In a fast flow the surface is a cloud of grains, and the density falls all the way, by 4 % from 1.5
/// to 3; it does so slowest about 2.
pub const FREE_SURFACE: f64 = 2.0;

/// Packing density of each grain: area of its disk over area of its cell; 0 without a cell.
///
/// A disk that overlaps others or sticks out of the domain counts in full.
pub fn local_densities(radii: &[f64], areas: &[f64]) -> Vec<f64> {
    let density = |(radius, &area): (&f64, &f64)| if area > 0.0 { PI * radius * radius / area } else { 0.0 };
    radii.iter().zip(areas).map(density).collect()
}

/// Packing density of the bulk: disks over cells, without the cells of the free surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Bulk {
    /// Sum of disks over sum of cells.
    pub density: f64,
    /// Cells that count.
    pub cells: usize,
    /// Largest area over its disk's that counts.
    pub limit: f64,
}

/// Bulk density without cells that are larger than `threshold` times the mean cell, both measured in
/// areas of their own disk, so that large grains are not taken for free surface.
///
/// The mean is that of the cells that count, so it is found by repetition, from the middle cell on. `None` if no cell has an area.
pub fn bulk_density(radii: &[f64], areas: &[f64], threshold: f64) -> Option<Bulk> {
    let disks: Vec<f64> = radii.iter().map(|radius| PI * radius * radius).collect();
    bulk_of(&disks, areas, threshold)
}

/// The same for grains of any shape: `solids` are their areas or volumes, `cells` those of their cells.
pub fn bulk_of(solids: &[f64], cells: &[f64], threshold: f64) -> Option<Bulk> {
    let cells = solids.iter().copied().zip(cells.iter().copied());
    let mut cells: Vec<(f64, f64)> = cells.filter(|&(solid, cell)| cell > 0.0 && solid > 0.0).collect();
    // From compact to loose; what counts is always a beginning of this list.
    cells.sort_unstable_by(|a, b| (a.1 / a.0).total_cmp(&(b.1 / b.0)));
    // Far cells are boundless but for the domain: the middle one is where the mean starts.
    let &(disk, area) = cells.get(cells.len() / 2)?;
    let mut limit = threshold * area / disk;
    loop {
        let count = cells.partition_point(|(disk, area)| area / disk <= limit);
        let (disks, total) =
            cells[..count].iter().fold((0.0, 0.0), |(a, b), (disk, area)| (a + disk, b + area));
        let next = threshold * total / disks;
        // A larger limit has a larger mean: limits only grow, or only shrink, until they count the same cells.
        if cells.partition_point(|(disk, area)| area / disk <= next) == count {
            return Some(Bulk { density: disks / total, cells: count, limit });
        }
        limit = next;
    }
}
