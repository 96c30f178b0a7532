//! Bodies of a scene by their outlines: obstacles in a fluid, bodies of a continuum.

use crate::problems::Problems;
use crate::scene::fluid::ShapeSpec;
use granular_core::shape::{Ball, Block, Hole, Polygon, SolidShape};
use granular_core::{D2, Dim, Vector};
use std::sync::Arc;

/// A body of a scene, or what is wrong with it.
pub(crate) fn solid<D: Dim>(
    path: &str,
    spec: &ShapeSpec,
    problems: &mut Problems,
) -> Option<Arc<dyn SolidShape<D>>> {
    match spec {
        ShapeSpec::Ball { centre, radius } => {
            let centre = problems.vector::<D, _>(&format!("{path}.centre"), centre);
            let radius = radius.value();
            if radius <= 0.0 {
                problems.add(format!("{path}.radius"), format!("{radius} m"), "above 0", "");
                return None;
            }
            Some(Arc::new(Ball { centre: centre?, radius }))
        }
        ShapeSpec::Block { low, high } => {
            let low = problems.vector::<D, _>(&format!("{path}.low"), low);
            let high = problems.vector::<D, _>(&format!("{path}.high"), high);
            let (low, high): (D::Vec, D::Vec) = (low?, high?);
            if (0..D::N).any(|axis| low.component(axis) >= high.component(axis)) {
                let allowed = "above low along every axis";
                problems.add(format!("{path}.high"), "not above low", allowed, "");
                return None;
            }
            Some(Arc::new(Block { low, high }))
        }
        ShapeSpec::Polygon(corners) => {
            let corner = |(k, corner): (usize, &Vec<_>)| {
                problems.vector::<D2, _>(&format!("{path}.Polygon.{k}"), corner)
            };
            let corners: Vec<_> = corners.iter().enumerate().map(corner).collect::<Option<_>>()?;
            if corners.len() < 3 {
                let value = format!("a Polygon of {} corners", corners.len());
                problems.add(path, value, "three corners or more", "");
                return None;
            }
            Some(Arc::new(Polygon { corners }))
        }
        ShapeSpec::Hole(inner) => Some(Arc::new(Hole(solid::<D>(&format!("{path}.Hole"), inner, problems)?))),
    }
}
