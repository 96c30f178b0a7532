//! States that speed is measured on, as text that other programs can read.
//!
//! A row is `x y vx vy omega r` for a disk, `x y z vx vy vz wx wy wz r` for a sphere, or, for
//! grains at rest, `x y r` and `x y z r`, in SI units.

use granular_core::glam::DVec2;
use granular_core::random::Chance;
use granular_core::{D2, Dim, FieldRef, Linear, Solver, Spin, Vector};
use granular_dem::{Dem2, Grain, Material, MaterialId, Materials, Options, Setup, Wall};
use granular_driver::failure::Failure;
use granular_packing::{Sides, ballistic};
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;

/// Contact time of the mean pair \[s\]; a step is a fiftieth of it.
pub(super) const CONTACT_TIME: f64 = 92.5e-6;
/// Step \[s\].
pub(super) const DT: f64 = CONTACT_TIME / 50.0;
/// Step while the column falls to the state in flight \[s\].
const COARSE_DT: f64 = CONTACT_TIME / 15.0;
/// Largest number of grains that are let fall until they are in flight; more have just been let go.
const IN_FLIGHT: usize = 20_000;
/// Steps of a column that has just been let go.
const JUST_OPENED: u64 = 2000;

pub(super) const GRAVITY: f64 = 9.81;
pub(super) const DIAMETERS: [f64; 2] = [0.92e-3, 1.38e-3];
const ASPECT_RATIO: f64 = 0.8;
/// Solid fraction of the deposit, for its width.
const SOLID: f64 = 0.815;
/// Part of the deposit that is taken off to level it.
const TAKEN_OFF: f64 = 0.15;

/// A grain of a state: position \[m\], velocity \[m/s\], spin \[rad/s\] and radius \[m\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball<D: Dim> {
    pub(super) position: D::Vec,
    pub(super) velocity: D::Vec,
    pub(super) spin: D::Spin,
    pub(super) radius: f64,
}

impl<D: Dim> Ball<D> {
    pub(super) fn at_rest(position: D::Vec, radius: f64) -> Self {
        Self { position, velocity: D::Vec::ZERO, spin: D::Spin::ZERO, radius }
    }

    pub(super) fn grain(&self, material: MaterialId) -> Grain<D> {
        Grain::at(self.position, self.radius, material).moving(self.velocity).turning(self.spin)
    }
}

/// A column of so many disks after its gate has opened.
///
/// # Errors
/// When the column cannot be made, or the solver gives up.
pub(super) fn falling(count: usize) -> Result<Vec<Ball<D2>>, Failure> {
    let column = deposit(count, 1)?;
    let height = column.iter().map(|disk| disk.position.y + disk.radius).fold(0.0, f64::max);
    let mut dem = simulation(&column)?;
    let (dt, steps) = if count <= IN_FLIGHT {
        (COARSE_DT, (0.5 * (height / GRAVITY).sqrt() / COARSE_DT) as u64)
    } else {
        (DT, JUST_OPENED)
    };
    dem.advance(dt, steps)?;
    let mut disks: Vec<(u32, Ball<D2>)> = dem
        .grains()
        .map(|(id, grain)| {
            let Grain { position, velocity, spin, radius, .. } = grain;
            (id, Ball { position, velocity, spin, radius })
        })
        .collect();
    disks.sort_by_key(|(id, _)| *id);
    Ok(disks.into_iter().map(|(_, disk)| disk).collect())
}

/// A level ballistic deposit with diameters spread evenly by number.
fn deposit(count: usize, seed: u64) -> Result<Vec<Ball<D2>>, Failure> {
    let mut chance = Chance::new(seed);
    let more = (count as f64 / (1.0 - TAKEN_OFF)).ceil() as usize;
    let radii: Vec<f64> = (0..more).map(|_| 0.5 * chance.between(DIAMETERS[0], DIAMETERS[1])).collect();
    let area = radii.iter().map(|radius| PI * radius * radius).sum::<f64>() * count as f64 / more as f64;
    let width = (area / (SOLID * ASPECT_RATIO)).sqrt();
    let deposit = ballistic(&radii, width, Sides::Walls, seed).map_err(|e| Failure::Io(e.to_string()))?;
    let disks = deposit.positions.into_iter().zip(radii);
    let mut disks: Vec<Ball<D2>> = disks.map(|(position, radius)| Ball::at_rest(position, radius)).collect();
    disks.sort_by(|a, b| (a.position.y + a.radius).total_cmp(&(b.position.y + b.radius)));
    disks.truncate(count);
    Ok(disks)
}

/// A state between floor and left wall, ready to be timed.
///
/// # Errors
/// When a disk is out of range.
pub(super) fn simulation(disks: &[Ball<D2>]) -> Result<Dem2, Failure> {
    let wrong = |error: granular_dem::SetupError| Failure::Io(format!("state: {error}"));
    let mut materials = Materials::new();
    let material = Material { restitution: 0.75, damping_ratio: 0.0, friction: 0.53, ..Material::default() };
    let glass = materials.add(material).map_err(wrong)?;
    let plane = |name, normal| Wall::plane(name, DVec2::ZERO, normal, glass).map_err(wrong);
    let walls = vec![plane("floor", DVec2::Y)?, plane("left", DVec2::X)?];
    let grains = disks.iter().map(|disk| disk.grain(glass)).collect();
    let gravity = DVec2::new(0.0, -GRAVITY);
    Dem2::new(Setup { materials, grains, walls, gravity, options: Options::default() }).map_err(wrong)
}

/// Reads a state.
///
/// # Errors
/// When the file cannot be read, or a row is not one of a grain.
pub(super) fn read<D: Dim>(path: &Path) -> Result<Vec<Ball<D>>, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::io(path.display(), error))?;
    let rows = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    rows.map(|(index, line)| {
        ball(line).ok_or_else(|| {
            let place = format!("{}, line {}", path.display(), index + 1);
            Failure::io(
                place,
                "expected the numbers of position, velocity, spin and radius, or of position and radius",
            )
        })
    })
    .collect()
}

/// Whether the file holds spheres rather than disks.
///
/// # Errors
/// When the file cannot be read.
pub(super) fn holds_spheres(path: &Path) -> Result<bool, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::io(path.display(), error))?;
    let row = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    Ok([4, 10].contains(&row.split_whitespace().count()))
}

fn ball<D: Dim>(line: &str) -> Option<Ball<D>> {
    let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let (&radius, rest) = numbers.split_last()?;
    let position = D::Vec::from_slice(rest.get(..D::N)?)?;
    if rest.len() == D::N {
        return Some(Ball::at_rest(position, radius));
    }
    let velocity = D::Vec::from_slice(rest.get(D::N..2 * D::N)?)?;
    let spin = match rest[2 * D::N..] {
        [z] => D::Spin::about_z(z),
        [x, y, z] => D::Spin::of_components([x, y, z]),
        _ => return None,
    };
    Some(Ball { position, velocity, spin, radius })
}

/// Writes a state, with digits that give the same numbers back; in short rows when all is at rest.
///
/// # Errors
/// When the file cannot be written.
pub(super) fn write<D: Dim>(balls: &[Ball<D>], path: &Path) -> Result<(), Failure> {
    let resting = balls.iter().all(|ball| ball.velocity == D::Vec::ZERO && ball.spin == D::Spin::ZERO);
    let mut text = String::new();
    for Ball { position, velocity, spin, radius } in balls {
        for vector in [position, velocity].into_iter().take(if resting { 1 } else { 2 }) {
            (0..D::N).for_each(|axis| _ = write!(text, "{:e} ", vector.component(axis)));
        }
        match D::spin_field(&[*spin]) {
            _ if resting => {}
            FieldRef::Vector3(spins) => {
                _ = write!(text, "{:e} {:e} {:e} ", spins[0].x, spins[0].y, spins[0].z)
            }
            _ => _ = write!(text, "{:e} ", spin.z()),
        }
        let _ = writeln!(text, "{radius:e}");
    }
    granular_io::write_atomically(path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D3;
    use granular_core::glam::DVec3;

    fn comes_back<D: Dim>(name: &str, balls: &[Ball<D>]) {
        let path = std::env::temp_dir().join(format!("granular-state-{name}-{}.txt", std::process::id()));
        write(balls, &path).unwrap();
        let (back, spheres) = (read(&path), holds_spheres(&path));
        std::fs::remove_file(&path).unwrap();
        let same = |a: &Ball<D>, b: &Ball<D>| {
            a.position == b.position && a.velocity == b.velocity && a.spin == b.spin && a.radius == b.radius
        };
        let back = back.unwrap();
        assert!(back.len() == balls.len() && back.iter().zip(balls).all(|(a, b)| same(a, b)), "{back:?}");
        assert_eq!(spheres.unwrap(), D::N == 3);
    }

    #[test]
    fn a_state_comes_back_as_it_was_written() {
        let disks = falling(60).unwrap();
        assert!(disks.iter().any(|disk| disk.velocity.length() > 0.05));
        comes_back("disks", &disks);
        let sphere = Ball::<D3> {
            position: DVec3::new(0.1, 0.2, 0.3),
            velocity: DVec3::new(1.0 / 3.0, 0.0, -2e-9),
            spin: DVec3::new(0.0, 7.0, 1e12),
            radius: 1e-3,
        };
        comes_back("spheres", &[sphere, Ball::at_rest(DVec3::X, 2.0)]);
        comes_back("resting", &[Ball::<D3>::at_rest(DVec3::X, 2.0)]);
        assert_eq!(ball::<D2>("1 2 3").map(|disk| disk.radius), Some(3.0));
        assert!(ball::<D2>("1 2 3 4").is_none());
        assert_eq!(ball::<D3>("1 2 3 4").map(|sphere| sphere.radius), Some(4.0));
    }
}
