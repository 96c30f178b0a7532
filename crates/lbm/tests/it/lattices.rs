//! Identities of the lattices.

use granular_lbm::{D2Q9, D3Q19, Lattice, opposite};

fn identities<L: Lattice<Q>, const Q: usize>() {
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{}: {a} {b}", L::NAME);
    let sum = |value: &dyn Fn(usize) -> f64| (0..Q).map(|i| L::WEIGHTS[i] * value(i)).sum::<f64>();
    let c = |i: usize, axis: usize| f64::from(L::VELOCITIES[i][axis]);
    let axes = if Q == 9 { 2 } else { 3 };
    close(sum(&|_| 1.0), 1.0);
    for a in 0..axes {
        for b in 0..axes {
            let same = f64::from(u8::from(a == b));
            close(sum(&|i| c(i, a) * c(i, b)), same / 3.0);
            for (d, e) in (0..axes).flat_map(|d| (0..axes).map(move |e| (d, e))) {
                let delta = |p: usize, q: usize| f64::from(u8::from(p == q));
                let isotropic =
                    (delta(a, b) * delta(d, e) + delta(a, d) * delta(b, e) + delta(a, e) * delta(b, d)) / 9.0;
                close(sum(&|i| c(i, a) * c(i, b) * c(i, d) * c(i, e)), isotropic);
            }
        }
    }
    for i in 0..Q {
        assert!((0..3).all(|axis| L::VELOCITIES[i][axis] == -L::VELOCITIES[opposite(i)][axis]));
        assert_eq!(opposite(opposite(i)), i);
    }
    // Ghosts carry neither mass, momentum nor deviator of stress, and are orthogonal to each other.
    for (k, ghost) in L::GHOSTS.iter().enumerate() {
        let dot = |value: &dyn Fn(usize) -> f64| (0..Q).map(|i| ghost[i] * value(i)).sum::<f64>();
        close(dot(&|_| 1.0), 0.0);
        for a in 0..axes {
            close(dot(&|i| c(i, a)), 0.0);
            for b in 0..axes {
                if a != b {
                    close(dot(&|i| c(i, a) * c(i, b)), 0.0);
                    close(dot(&|i| c(i, a).powi(2) - c(i, b).powi(2)), 0.0);
                }
            }
        }
        for other in &L::GHOSTS[..k] {
            close(dot(&|i| other[i]), 0.0);
        }
    }
}

#[test]
fn moments_are_isotropic_to_fourth_order_and_ghosts_orthogonal() {
    identities::<D2Q9, 9>();
    identities::<D3Q19, 19>();
}

/// Moments of the equilibrium in closed form \[Lallemand2000\]: `rho (1, -2 + 3 u^2, 1 - 3 u^2, u_x, -u_x, u_y, -u_y, u_x^2 - u_y^2,
/// u_x u_y)`; the thesis prints those of another equilibrium, and a singular last row of the matrix.
#[test]
fn moments_of_the_equilibrium_are_those_of_the_closed_form() {
    let (density, x, y) = (1.03, 0.07, -0.04);
    let squared = x * x + y * y;
    let equilibrium: Vec<f64> = (0..9)
        .map(|i| {
            let [cx, cy, _] = D2Q9::VELOCITIES[i].map(f64::from);
            let along = cx * x + cy * y;
            D2Q9::WEIGHTS[i] * density * (1.0 + 3.0 * along + 4.5 * along * along - 1.5 * squared)
        })
        .collect();
    let moment = |value: &dyn Fn(f64, f64) -> f64| -> f64 {
        (0..9)
            .map(|i| {
                value(f64::from(D2Q9::VELOCITIES[i][0]), f64::from(D2Q9::VELOCITIES[i][1])) * equilibrium[i]
            })
            .sum()
    };
    let length = |a: f64, b: f64| a * a + b * b;
    let ghost = |k: usize| (0..9).map(|i| D2Q9::GHOSTS[k][i] * equilibrium[i]).sum::<f64>();
    let pairs = [
        (moment(&|_, _| 1.0), 1.0),
        (ghost(0), -2.0 + 3.0 * squared),
        (ghost(1), 1.0 - 3.0 * squared),
        (moment(&|a, _| a), x),
        (moment(&|a, b| a * (3.0 * length(a, b) - 5.0)), -x),
        (moment(&|_, b| b), y),
        (moment(&|a, b| b * (3.0 * length(a, b) - 5.0)), -y),
        (moment(&|a, b| a * a - b * b), x * x - y * y),
        (moment(&|a, b| a * b), x * y),
    ];
    for (k, (found, expected)) in pairs.into_iter().enumerate() {
        assert!((found - density * expected).abs() < 1e-15, "moment {k}: {found} {expected}");
    }
}
