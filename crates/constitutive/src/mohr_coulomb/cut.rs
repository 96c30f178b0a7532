//! The pyramid of Mohr-Coulomb cut at a tensile strength.
//!
//! In sorted principal stresses the cut surface has two faces (shear, tension), edges where faces and their mirror images meet, and corners. Each
//! has a closed form for the stress to which a trial stress would return and for the plastic strain. Right is the one
//! whose stress is sorted and within both faces and whose plastic strain is a sum of flows with factors of at least zero. All
//! are computed, and the one that violates these least is taken: on the border between two regions both are right to round-off.

use super::Returned;
use super::pyramid::Pyramid;
use crate::elastic::LinearElastic;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Tensile strength.
    pub(super) tension: f64,
    /// Poisson's ratio.
    poisson: f64,
    /// `nu / (1 - nu)`: change of stress across an axis, in confined strain along it.
    lateral: f64,
    /// `2 G`, which makes stresses of strains.
    stiffness: f64,
}

/// A stress, and by how much \[Pa\] it or its plastic strain is not allowed.
type Candidate = ([f64; 3], f64);

impl Cut {
    pub(super) fn at(tension: f64, elastic: &LinearElastic) -> Self {
        let (bulk, shear) = (elastic.bulk(), elastic.shear());
        let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
        Self { tension, poisson, lateral: poisson / (1.0 - poisson), stiffness: 2.0 * shear }
    }

    #[inline(always)]
    pub(super) fn returned(&self, pyramid: &Pyramid, b: [f64; 3]) -> Returned {
        let (tip, at_tip) = self.tip(pyramid, b);
        let mut best = (tip, at_tip);
        let mut is_tip = true;
        for other in [
            self.shear_face(pyramid, b),
            self.shear_edge(pyramid, b, 0),
            self.shear_edge(pyramid, b, 1),
            self.tension_face(pyramid, b),
            self.tension_edge(pyramid, b),
            self.mixed_edge(pyramid, b),
            self.first_corner(pyramid, b),
            self.second_corner(pyramid, b),
        ] {
            let better = other.1 < best.1;
            best.0 = std::array::from_fn(|i| if better { other.0[i] } else { best.0[i] });
            best.1 = if better { other.1 } else { best.1 };
            is_tip &= !better;
        }
        // The product keeps what is not finite.
        let kept = 0.0 * (b[0] + b[1] + b[2]);
        Returned { values: best.0.map(|value| value + kept), at_tip: is_tip }
    }

    /// How far a stress is beyond order and strength.
    #[inline(always)]
    fn excess(&self, pyramid: &Pyramid, s: [f64; 3]) -> f64 {
        let order = larger(s[1] - s[0], s[2] - s[1]);
        larger(order, larger(s[0] - self.tension, pyramid.excess(s)))
    }

    /// Plastic strain times `2 G`.
    #[inline(always)]
    fn plastic(&self, pyramid: &Pyramid, b: [f64; 3], s: [f64; 3]) -> [f64; 3] {
        pyramid.strain([b[0] - s[0], b[1] - s[1], b[2] - s[2]]).map(|strain| strain * self.stiffness)
    }

    #[inline(always)]
    fn shear_face(&self, pyramid: &Pyramid, b: [f64; 3]) -> Candidate {
        let s = pyramid.on_plane(b);
        (s, larger(self.excess(pyramid, s), -pyramid.excess(b)))
    }

    #[inline(always)]
    fn shear_edge(&self, pyramid: &Pyramid, b: [f64; 3], edge: usize) -> Candidate {
        let largest = pyramid.along_edge(edge, b);
        let smallest = pyramid.smallest(largest);
        let s = [largest, if edge == 0 { largest } else { smallest }, smallest];
        let strain = self.plastic(pyramid, b, s);
        // Flows (m, 0, -1) and (0, m, -1), or (m, 0, -1) and (m, -1, 0).
        let least = if edge == 0 { smaller(strain[0], strain[1]) } else { -larger(strain[1], strain[2]) };
        (s, larger(self.excess(pyramid, s), -least))
    }

    #[inline(always)]
    fn tension_face(&self, pyramid: &Pyramid, b: [f64; 3]) -> Candidate {
        let lost = b[0] - self.tension;
        let s = [self.tension, b[1] - self.lateral * lost, b[2] - self.lateral * lost];
        (s, larger(self.excess(pyramid, s), -lost))
    }

    #[inline(always)]
    fn tension_edge(&self, pyramid: &Pyramid, b: [f64; 3]) -> Candidate {
        let t = self.tension;
        let s = [t, t, b[2] - self.poisson * (b[0] + b[1] - 2.0 * t)];
        let strain = self.plastic(pyramid, b, s);
        (s, larger(self.excess(pyramid, s), -smaller(strain[0], strain[1])))
    }

    /// Shear and tension at once, with the middle stress free.
    #[inline(always)]
    fn mixed_edge(&self, pyramid: &Pyramid, b: [f64; 3]) -> Candidate {
        let (t, smallest) = (self.tension, pyramid.smallest(self.tension));
        let s = [t, b[1] - self.poisson * (b[0] - t + b[2] - smallest), smallest];
        let [first, _, last] = self.plastic(pyramid, b, s);
        // Flows (m, 0, -1) and (1, 0, 0).
        let least = smaller(-last, first + pyramid.m * last);
        (s, larger(self.excess(pyramid, s), -least))
    }

    /// Two stresses at the tensile strength, the third at the strength in shear.
    #[inline(always)]
    fn first_corner(&self, pyramid: &Pyramid, b: [f64; 3]) -> Candidate {
        let s = [self.tension, self.tension, pyramid.smallest(self.tension)];
        let [first, second, last] = self.plastic(pyramid, b, s);
        // Flows (m, 0, -1), (0, m, -1), (1, 0, 0) and (0, 1, 0).
        let least = smaller(smaller(first, second), smaller(-last, first + second + pyramid.m * last));
        (s, -least)
    }

    /// The largest stress at the tensile strength, both others at the strength in shear.
    #[inline(always)]
    fn second_corner(&self, pyramid: &Pyramid, b: [f64; 3]) -> Candidate {
        let smallest = pyramid.smallest(self.tension);
        let s = [self.tension, smallest, smallest];
        let [first, second, last] = self.plastic(pyramid, b, s);
        // Flows (m, 0, -1), (m, -1, 0) and (1, 0, 0).
        let least = smaller(-larger(second, last), first + pyramid.m * (second + last));
        (s, -least)
    }

    /// All stresses at the tensile strength.
    #[inline(always)]
    fn tip(&self, pyramid: &Pyramid, b: [f64; 3]) -> Candidate {
        let s = [self.tension; 3];
        let [first, second, last] = self.plastic(pyramid, b, s);
        (s, -smaller(smaller(first, second), last))
    }
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
