//! Additively weighted Voronoi diagrams of disks (Apollonius diagrams) by sweep line, and power cells of spheres.
//!
//! A point belongs to the disk whose surface is nearest, $\min_i |x - x_i| - r_i$, so a disk that overlaps no
//! other lies within its own cell; the ordinary diagram, of points, does not have this property. Packing density grain
//! by grain is the area of a disk over that of its cell \[Kumar2014, section 3.5.7\].
//!
//! # Method
//!
//! A line sweeps up, as for points \[Fortune1987\]. Between it and what is settled runs the beach line, of arcs of
//! parabolas $2 y = (y_i + r_i) + s - (x - x_i)^2 / (s - (y_i - r_i))$ where $s$ is the height of the line: a disk is met at
//! its lowest point, and is hidden if its centre is below the beach line by then. Breaks between arcs draw the edges, parts
//! of hyperbola branches; an arc vanishes in a vertex, the centre of a circle that touches three disks. Sorting and a
//! balanced tree make $O(n \log n)$.
//!
//! Whether a disk is hidden, on which side of a break it lies, whether an arc vanishes and which one does first are
//! signs of polynomials in the coordinates, in the last two cases with one or two square roots. Each sign is taken from
//! floating-point numbers that carry a bound on their error, and, if that leaves it open, from exact ones: the diagram has
//! the true topology for the coordinates as given, and any input works, lattices, duplicates and disks that touch from
//! inside too. Only places of vertices are rounded. Where more than three disks are equally near to a point, edges
//! of length zero resolve it.
//!
//! [`Cells`] cuts edges to a convex [`Domain`]; areas are those of the polygons of corners and, between a chord and
//! its hyperbola $(a \cosh \eta, b \sinh \eta)$, $\frac{1}{2} a b (\sinh \Delta\eta - \Delta\eta)$.
//!
//! # Example
//!
//! ```
//! use granular_core::glam::DVec2;
//! use granular_tessellate::{Diagram, Domain, bulk_density, local_densities, FREE_SURFACE};
//!
//! # fn main() -> Result<(), granular_tessellate::TessellationError> {
//! let centres = [DVec2::new(-1.0, 0.0), DVec2::new(1.0, 0.0), DVec2::new(1.2, 0.0)];
//! let radii = [0.5, 0.1, 0.3];
//! let diagram = Diagram::new(&centres, &radii)?;
//! assert_eq!(diagram.hidden_by(1), Some(2)); // touches the third from inside
//!
//! let domain = Domain::rectangle(DVec2::splat(-2.0), DVec2::splat(2.0))?;
//! let cells = diagram.cells(&domain);
//! assert!((cells.areas().iter().sum::<f64>() - 16.0).abs() < 1e-14);
//! assert_eq!(cells.neighbours(0), [2]);
//! for side in cells.boundary(0).iter().flatten() {
//!     println!("{:?}: {} to {}", side.neighbour, side.from, side.to);
//! }
//! let densities = local_densities(&radii, cells.areas());
//! let bulk = bulk_density(&radii, cells.areas(), FREE_SURFACE);
//! # assert!(bulk.is_some() && densities[0] > 0.0);
//! # Ok(())
//! # }
//! ```
//!
//! # Options
//!
//! | choice | meaning | source |
//! |---|---|---|
//! | [`Diagram::new`] | additively weighted, disks of any size | \[Fortune1987, section 4\] |
//! | [`Diagram::of_points`] | ordinary Voronoi diagram; its dual is a Delaunay triangulation | \[Fortune1987\] |
//! | [`periodic_areas`] | areas in a plane that repeats along two edges | |
//! | [`power_cells`] | power diagram of spheres in a box | \[Aurenhammer1987\] |
//! | [`bulk_density`] | density without the cells of the free surface | \[Kumar2014, section 3.5.7\] |
//!
//! # How it is tested
//!
//! Random and adversarial diagrams of up to about sixty sites (lattices, sites on common lines and circles, near-duplicates, disks that touch
//! from inside, radii over six decades, coordinates scaled by 1e-12 and 1e12) must obey the definition: areas sum to the
//! domain, boundaries close, no site is nearer to a vertex than its own three, the graph obeys Euler. 3000 are run by default, as many as
//! the environment variable `GRANULAR_DIAGRAMS` says otherwise; the last run of a million found no fault.
//!
//! # Limits
//!
//! - In space only power cells; the module of [`power_cells`] says why. There is no power diagram in the plane: it is not
//!   a special case of this sweep.
//! - Coordinates and radii up to 1e150; those below 1e-300 of the largest may lose digits.
//! - Exact arithmetic is slow: input that is degenerate everywhere takes longer.
//! - Places of vertices are good to about 1e-11 of the circle that defines them, mostly far better; vertices very far
//!   from the sites less.

mod beach;
mod bounded;
mod cells;
mod circle;
mod curve;
mod density;
mod diagram;
mod domain;
mod dyadic;
mod error;
mod locate;
mod periodic;
mod pieces;
mod power;
mod predicates;
mod queue;
mod site;
mod sweep;

pub use cells::{Cells, Side};
pub use curve::Curve;
pub use density::{Bulk, FREE_SURFACE, bulk_density, bulk_of, local_densities};
pub use diagram::{Diagram, Edge};
pub use domain::Domain;
pub use error::TessellationError;
pub use locate::encloses;
pub use periodic::periodic_areas;
pub use power::{PowerCell, power_cells};
pub use sweep::Vertex;
