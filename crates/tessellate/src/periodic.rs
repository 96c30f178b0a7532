//! Cells in a periodic plane.

use crate::diagram::Diagram;
use crate::domain::Domain;
use crate::error::TessellationError;
use granular_core::glam::{DMat2, DVec2};

/// Mean spacings of sites by which images reach beyond the period at first.
const MARGIN: f64 = 5.0;

/// Areas may sum to the period with this relative error.
const ROUNDING: f64 = 1e-11;

/// Areas of the cells of disks in a plane that repeats along two `edges`, counter-clockwise. They sum to the area of the
/// parallelogram that the edges span, wherever in the plane the disks are given.
///
/// Images of the disks are added around the parallelogram. Too few of them make cells too large, never too small, so the sum
/// tells when there are enough.
///
/// # Errors
/// As [`Diagram::new`], and when the edges span no parallelogram counter-clockwise.
pub fn periodic_areas(
    positions: &[DVec2],
    radii: &[f64],
    edges: [DVec2; 2],
) -> Result<Vec<f64>, TessellationError> {
    let [a, b] = edges;
    let whole = Domain::polygon(&[DVec2::ZERO, a, a + b, b])?.area();
    // Bad input is refused by its own number, not by that of an image.
    if positions.is_empty() || radii.len() != positions.len() || !all_finite(positions, radii) {
        Diagram::new(positions, radii)?;
    }
    let frame = DMat2::from_cols(a, b);
    let inverse = frame.inverse();
    let reduced: Vec<DVec2> = positions
        .iter()
        .map(|&position| {
            let place = inverse * position;
            place - place.floor()
        })
        .collect();
    let spacing = (whole / positions.len() as f64).sqrt();
    // As a share of the period: the height of the parallelogram over an edge is its area by that edge.
    let mut margin = DVec2::new(b.length(), a.length()) * (MARGIN * spacing / whole);
    loop {
        let areas = with_images(&reduced, radii, frame, margin)?;
        if let Some(areas) = areas
            && (areas.iter().sum::<f64>() - whole).abs() <= ROUNDING * whole
        {
            return Ok(areas);
        }
        margin *= 2.0;
    }
}

fn all_finite(positions: &[DVec2], radii: &[f64]) -> bool {
    positions.iter().all(|position| position.is_finite()) && radii.iter().all(|radius| radius.is_finite())
}

/// Areas with images up to a margin; none if the end of the images cuts a cell.
fn with_images(
    reduced: &[DVec2],
    radii: &[f64],
    frame: DMat2,
    margin: DVec2,
) -> Result<Option<Vec<f64>>, TessellationError> {
    let (low, high) = (-margin, DVec2::ONE + margin);
    let (mut sites, mut sizes) = (reduced.to_vec(), radii.to_vec());
    let reach = margin.ceil();
    let steps = |most: f64| (0..=2 * most as i32).map(move |step| f64::from(step) - most);
    for shift in steps(reach.x).flat_map(|x| steps(reach.y).map(move |y| DVec2::new(x, y))) {
        for (&place, &radius) in reduced.iter().zip(radii) {
            let image = place + shift;
            if shift != DVec2::ZERO && image.cmpge(low).all() && image.cmple(high).all() {
                sites.push(image);
                sizes.push(radius);
            }
        }
    }
    sites.iter_mut().for_each(|site| *site = frame * *site);
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let domain = Domain::polygon(&corners.map(|corner| frame * corner))?;
    let diagram = Diagram::new(&sites, &sizes)?;
    let cells = diagram.cells(&domain);
    let count = reduced.len();
    let cut = (0..count).any(|site| cells.at_boundary(site));
    Ok((!cut).then(|| cells.areas()[..count].to_vec()))
}
