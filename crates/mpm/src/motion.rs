//! How particles of a batch move and strain with the nodes.

use crate::batch::BATCH;
use crate::layout::Node;
use crate::particles::{components, stress_components};
use crate::turning::{Gradients, Turning};
use granular_core::{Dim, Linear, SymmetricTensor, Vector};
use multiversion::multiversion;

/// What a pass from nodes to particles changes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plan {
    /// Step \[s\].
    pub(crate) dt: f64,
    /// Whether velocities change, by the second vector that nodes hold.
    pub(crate) velocity: bool,
    /// Share of the velocity that is that of the nodes.
    pub(crate) pic_share: f64,
    /// Whether what particles give up is lost, rather than kept as affine motion.
    pub(crate) books_pic: bool,
    /// Whether particles move, with the first vector that nodes hold.
    pub(crate) position: bool,
    /// Whether they strain, with the first (0) or the second (1) vector.
    pub(crate) strain: Option<usize>,
    /// Whether losses are summed.
    pub(crate) ledger: bool,
}

/// What is looked at in every step. Numbers that are not negative order like their bits, and what is not a number or less than
/// zero is above them all.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Watch {
    /// Greatest square of a speed \[m^2/s^2\].
    pub(crate) fastest: u64,
    /// Greatest volume over that at the start.
    pub(crate) loosest: u64,
    /// Sum over particles of their volumes over those at the start; one for those that carry nothing.
    pub(crate) stretched: f64,
    /// What was lost in the last pass: to PIC, to plastic strain and to viscosity \[J\].
    pub(crate) lost: [f64; 3],
}

impl Watch {
    pub(crate) fn join(self, other: Self) -> Self {
        Self {
            fastest: self.fastest.max(other.fastest),
            loosest: self.loosest.max(other.loosest),
            stretched: self.stretched + other.stretched,
            lost: [0, 1, 2].map(|kind: usize| self.lost[kind] + other.lost[kind]),
        }
    }

    /// Whether all numbers were finite and all volumes positive.
    pub(crate) fn is_sound(&self) -> bool {
        self.fastest.max(self.loosest) < f64::INFINITY.to_bits()
    }
}

/// Moves particles with what was summed for them over their nodes.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn move_particles<D: Dim>(
    plan: &Plan,
    sums: &[Node; BATCH],
    velocity: &mut [D::Vec],
    position: &mut [D::Vec],
    mass: &[f64],
    watch: &mut Watch,
) {
    let count = velocity.len().min(BATCH);
    let (velocity, position) = (&mut velocity[..count], &mut position[..count]);
    let first = |k: usize| D::Vec::from_fn(|axis| sums[k].0[axis]);
    if plan.velocity {
        let change = |k: usize| D::Vec::from_fn(|axis| sums[k].0[D::N + axis]);
        if plan.pic_share == 0.0 {
            for (k, velocity) in velocity.iter_mut().enumerate() {
                *velocity += change(k);
            }
        } else {
            let mut lost = [0.0; BATCH];
            for k in 0..count {
                let own = velocity[k] + change(k);
                velocity[k] = own + (first(k) - own) * plan.pic_share;
                // The force that draws a particle to the velocity of the nodes, times its mean velocity.
                lost[k] = 0.5 * (own - velocity[k]).dot(own + velocity[k]);
            }
            if plan.ledger && plan.books_pic {
                watch.lost[0] += lost.iter().zip(&mass[..count]).map(|(lost, mass)| lost * mass).sum::<f64>();
            }
        }
    }
    if plan.position {
        let mut fastest = watch.fastest;
        for k in 0..count {
            let along = first(k);
            position[k] += along * plan.dt;
            fastest =
                fastest.max(along.length_squared().to_bits()).max(velocity[k].length_squared().to_bits());
        }
        watch.fastest = fastest;
    }
}

/// How particles of a batch strain.
pub(crate) struct Strains {
    /// Components of the strain of the step, in the order of stresses.
    pub(crate) strain: [[f64; BATCH]; 6],
    /// Volume after the step over that at the start.
    pub(crate) volume_ratio: [f64; BATCH],
}

impl Strains {
    pub(crate) fn new() -> Self {
        Self { strain: [[0.0; BATCH]; 6], volume_ratio: [1.0; BATCH] }
    }

    #[inline(always)]
    fn put<D: Dim>(&mut self, k: usize, strain: SymmetricTensor) {
        for (to, value) in self.strain.iter_mut().zip(components(strain)).take(stress_components::<D>()) {
            to[k] = value;
        }
    }

    /// The strain of particle `k`.
    #[inline(always)]
    pub(crate) fn at(&self, k: usize) -> SymmetricTensor {
        let [xx, yy, zz, xy, yz, xz] = &self.strain;
        SymmetricTensor { xx: xx[k], yy: yy[k], zz: zz[k], xy: xy[k], yz: yz[k], xz: xz[k] }
    }
}

/// A body's stresses, by component.
pub(crate) type Stress<'a> = [&'a mut [f64]; 6];

/// The stress of particle `k`.
#[inline(always)]
pub(crate) fn stress_at<D: Dim>(stress: &Stress<'_>, k: usize) -> SymmetricTensor {
    SymmetricTensor {
        xx: stress[0][k],
        yy: stress[1][k],
        zz: stress[2][k],
        xy: stress[3][k],
        yz: if D::N == 3 { stress[4][k] } else { 0.0 },
        xz: if D::N == 3 { stress[5][k] } else { 0.0 },
    }
}

#[inline(always)]
pub(crate) fn put_stress<D: Dim>(stress: &mut Stress<'_>, k: usize, value: SymmetricTensor) {
    stress[0][k] = value.xx;
    stress[1][k] = value.yy;
    stress[2][k] = value.zz;
    stress[3][k] = value.xy;
    if D::N == 3 {
        stress[4][k] = value.yz;
        stress[5][k] = value.xz;
    }
}

/// Cuts all components to a length, so that loops need not look again.
#[inline(always)]
pub(crate) fn cut<'a, D: Dim>(stress: &'a mut Stress<'_>, count: usize) -> Stress<'a> {
    let kept = stress_components::<D>();
    let mut component = 0;
    stress.each_mut().map(|values| {
        component += 1;
        if component <= kept { &mut values[..count] } else { &mut values[..0] }
    })
}

/// Finds strains of particles from the gradients that were summed for them (per cell), turns their stresses with them and lets
/// volumes follow.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn strain_particles<D: Dim, A: Gradients, T: Turning>(
    (dt_per_cell, vector, density): (f64, usize, f64),
    rows: &[[Node; BATCH]; 4],
    strains: &mut Strains,
    stress: &mut Stress<'_>,
    volume: &mut [f64],
    mass: &[f64],
    watch: &mut Watch,
) {
    let count = volume.len().min(BATCH);
    let (volume, mass) = (&mut volume[..count], &mass[..count]);
    let stress = &mut cut::<D>(stress, count);
    let lane = vector * D::N;
    let mut loosest = watch.loosest;
    let mut stretched = [0.0; BATCH];
    for k in 0..count {
        // Derivative of component `row` along `column`, times the step.
        let gradient = A::gradient(|row, column| rows[1 + column][k].0[(lane + row) & 7] * dt_per_cell);
        strains.put::<D>(k, A::strain(gradient));
        let before = stress_at::<D>(stress, k);
        put_stress::<D>(stress, k, T::turned::<A>(before, gradient));
        volume[k] *= A::stretch(gradient);
        let ratio = volume[k] * density / mass[k];
        strains.volume_ratio[k] = ratio;
        loosest = loosest.max(ratio.to_bits());
        // Material that carries nothing has separated: it has no waves until it is as dense as it was.
        let carries = before.xx != 0.0 || before.yy != 0.0 || before.zz != 0.0;
        stretched[k] = if carries { ratio } else { 1.0 };
    }
    watch.loosest = loosest;
    watch.stretched += stretched[..count].iter().sum::<f64>();
}
