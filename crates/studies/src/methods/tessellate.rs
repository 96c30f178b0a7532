//! Weighted Voronoi diagrams.

mod cells;
pub(super) mod speed;

use super::Method;
use crate::validate::cases;

cases! { "tessellate";
    tessellation: "cells of weighted Voronoi diagrams" => cells::run;
}

pub(super) const METHOD: Method = Method {
    cases: CASES,
    speed: Some(speed::THROUGHPUT),
    ..Method::named("tessellate", "Weighted Voronoi diagrams")
};
