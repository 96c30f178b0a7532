//! Which kernels a set-up needs.
//!
//! All kernels are compiled here, once for the plane and once for space, and not again in every crate that builds a simulation.

use crate::batch::{BATCH, Batch, Corner, give, take};
use crate::body::{Body, LawBody};
use crate::layout::{Node, TileShape};
use crate::load::{Givers, load};
use crate::motion::{Plan, Strains, Stress, Watch, move_particles, strain_particles};
use crate::setup::{ObjectiveRate, Options, ShapeFunctions, VelocityUpdate};
use crate::shape::{Arms, Linear, QuadraticBspline, Shape, UniformGimp};
use crate::turning::{ByRate, ByRotation, Gradients, Turning};
use granular_constitutive::{
    AnyLaw, Bingham, ConstitutiveLaw, DruckerPrager, InPlane, InSpace, LinearElastic, LinearFriction,
    MohrCoulomb, MuI, Newtonian, NorSand, SaturatingFriction,
};
use granular_core::{D2, D3, Dim};
use std::any::{Any, TypeId};

pub(crate) type Give<D> = fn(&mut Batch, &TileShape, &Corner<D>, (&[<D as Dim>::Vec], &[f64]), &mut [Node]);
type Take<D> = fn(&mut Batch, &TileShape, &Corner<D>, (&[<D as Dim>::Vec], &[f64]), &[Node]);
type Load<D> = fn(&mut [[Node; BATCH]; 4], &Givers<'_, D>, Option<f64>);
type Move<D> = fn(&Plan, &[Node; BATCH], &mut [<D as Dim>::Vec], &mut [<D as Dim>::Vec], &[f64], &mut Watch);
type Strain =
    fn((f64, usize, f64), &[[Node; BATCH]; 4], &mut Strains, &mut Stress<'_>, &mut [f64], &[f64], &mut Watch);

/// The kernels of a set-up, which know no law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kernels<D: Dim> {
    /// Lays out what particles give.
    pub(crate) load: Load<D>,
    /// From particles to nodes.
    pub(crate) give: Give<D>,
    /// From nodes to particles.
    pub(crate) take: Take<D>,
    /// The same for vectors that act on the arms from particles to nodes; none unless velocities are affine.
    pub(crate) affine: Option<(Give<D>, Take<D>)>,
    pub(crate) move_particles: Move<D>,
    pub(crate) strain_particles: Strain,
    /// Nodes that a particle reaches along an axis.
    pub(crate) reach: usize,
    /// Whether the width of particles matters.
    pub(crate) has_width: bool,
}

/// Kernels for some choices.
pub(crate) fn kernels<D: Dim>(options: &Options) -> Kernels<D> {
    in_dimension(|| of_plane(options), || of_space(options))
}

#[inline(never)]
fn of_plane(options: &Options) -> Kernels<D2> {
    of_shape::<D2, InPlane>(options)
}

#[inline(never)]
fn of_space(options: &Options) -> Kernels<D3> {
    of_shape::<D3, InSpace>(options)
}

fn of_shape<D: Dim, A: Gradients>(options: &Options) -> Kernels<D> {
    match options.shape {
        ShapeFunctions::Linear => of_rate::<D, A, Linear>(options),
        ShapeFunctions::UniformGimp => with_affine::<D, A, UniformGimp>(options),
        ShapeFunctions::QuadraticBspline => with_affine::<D, A, QuadraticBspline>(options),
    }
}

fn with_affine<D: Dim, A: Gradients, S: Shape>(options: &Options) -> Kernels<D> {
    let is_affine = options.velocity_update == VelocityUpdate::Apic;
    let kernels: (Give<D>, Take<D>) = (give::<D, Arms<S, true>>, take::<D, Arms<S, false>>);
    Kernels { affine: is_affine.then_some(kernels), ..of_rate::<D, A, S>(options) }
}

fn of_rate<D: Dim, A: Gradients, S: Shape>(options: &Options) -> Kernels<D> {
    match options.objective_rate {
        ObjectiveRate::HughesWinget => of::<D, A, S, ByRotation>(),
        ObjectiveRate::Jaumann => of::<D, A, S, ByRate>(),
    }
}

fn of<D: Dim, A: Gradients, S: Shape, T: Turning>() -> Kernels<D> {
    Kernels {
        load: load::<D>,
        give: give::<D, S>,
        take: take::<D, S>,
        affine: None,
        move_particles: move_particles::<D>,
        strain_particles: strain_particles::<D, A, T>,
        reach: S::NODES,
        has_width: S::HAS_WIDTH,
    }
}

/// What one of two functions makes, whichever is for this dimension.
fn in_dimension<P: 'static, S: 'static, T: 'static>(
    plane: impl FnOnce() -> P,
    space: impl FnOnce() -> S,
) -> T {
    let mut made: Box<dyn Any> = if TypeId::of::<P>() == TypeId::of::<T>() {
        Box::new(Some(plane()))
    } else {
        Box::new(Some(space()))
    };
    let made = made.downcast_mut::<Option<T>>().and_then(Option::take);
    made.expect("there are two dimensions")
}

/// The law of a body: one of ours, or [one's own](BodyLaw::own).
pub struct BodyLaw<D: Dim> {
    pub(crate) body: Box<dyn Body<D>>,
}

impl<D: Dim> std::fmt::Debug for BodyLaw<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("BodyLaw").field(&self.body).finish()
    }
}

impl<D: Dim> BodyLaw<D> {
    /// A law of one's own. Its kernel is compiled where this is called, for plane and space.
    pub fn own<L: ConstitutiveLaw>(law: L) -> Self {
        let other = law.clone();
        let body = in_dimension::<Box<dyn Body<D2>>, Box<dyn Body<D3>>, Box<dyn Body<D>>>(
            || Box::new(LawBody::<InPlane, L>::new(law)),
            || Box::new(LawBody::<InSpace, L>::new(other)),
        );
        Self { body }
    }
}

macro_rules! compiled_here {
    ($($law:ty),* $(,)?) => {$(
        impl<D: Dim> From<$law> for BodyLaw<D> {
            fn from(law: $law) -> Self {
                #[inline(never)]
                fn in_plane(law: $law) -> BodyLaw<D2> {
                    BodyLaw { body: Box::new(LawBody::<InPlane, $law>::new(law)) }
                }
                #[inline(never)]
                fn in_space(law: $law) -> BodyLaw<D3> {
                    BodyLaw { body: Box::new(LawBody::<InSpace, $law>::new(law)) }
                }
                let other = law.clone();
                in_dimension(|| in_plane(law), || in_space(other))
            }
        }
    )*};
}
compiled_here!(
    LinearElastic,
    MohrCoulomb,
    MohrCoulomb<true>,
    DruckerPrager,
    MuI<LinearFriction>,
    MuI<SaturatingFriction>,
    NorSand,
    Newtonian,
    Bingham,
);

impl<D: Dim> From<AnyLaw> for BodyLaw<D> {
    fn from(law: AnyLaw) -> Self {
        match law {
            AnyLaw::LinearElastic(law) => law.into(),
            AnyLaw::MohrCoulomb(law) => law.into(),
            AnyLaw::MohrCoulombWithCut(law) => law.into(),
            AnyLaw::DruckerPrager(law) => law.into(),
            AnyLaw::LinearMuI(law) => law.into(),
            AnyLaw::MuI(law) => law.into(),
            AnyLaw::NorSand(law) => law.into(),
            AnyLaw::Newtonian(law) => law.into(),
            AnyLaw::Bingham(law) => law.into(),
        }
    }
}
