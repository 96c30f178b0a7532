//! States of a collapsing column that speed is measured on, as text that other programs can read.
//!
//! A row is `x y vx vy omega r` or, for grains at rest, `x y r`, in SI units.

use crate::failure::Failure;
use crate::validate::chance::Chance;
use granular_core::Solver;
use granular_core::glam::DVec2;
use granular_dem::{Dem2, Grain, Material, Materials, Options, Setup, Wall};
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

const GRAVITY: f64 = 9.81;
const DIAMETERS: [f64; 2] = [0.92e-3, 1.38e-3];
const ASPECT_RATIO: f64 = 0.8;
/// Solid fraction of the deposit, for its width.
const SOLID: f64 = 0.815;
/// Part of the deposit that is taken off to level it.
const TAKEN_OFF: f64 = 0.15;

/// A disk of a state: position \[m\], velocity \[m/s\], spin \[rad/s\] and radius \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Disk {
    position: DVec2,
    velocity: DVec2,
    spin: f64,
    radius: f64,
}

/// A column of so many disks after its gate has opened.
///
/// # Errors
/// When the column cannot be made, or the solver gives up.
pub(super) fn falling(count: usize) -> Result<Vec<Disk>, Failure> {
    let column = deposit(count, 1)?;
    let height = column.iter().map(|disk| disk.position.y + disk.radius).fold(0.0, f64::max);
    let mut dem = simulation(&column)?;
    let (dt, steps) = if count <= IN_FLIGHT {
        (COARSE_DT, (0.5 * (height / GRAVITY).sqrt() / COARSE_DT) as u64)
    } else {
        (DT, JUST_OPENED)
    };
    dem.advance(dt, steps)?;
    let mut disks: Vec<(u32, Disk)> = dem
        .grains()
        .map(|(id, grain)| {
            let Grain { position, velocity, spin, radius, .. } = grain;
            (id, Disk { position, velocity, spin, radius })
        })
        .collect();
    disks.sort_by_key(|(id, _)| *id);
    Ok(disks.into_iter().map(|(_, disk)| disk).collect())
}

/// A level ballistic deposit with diameters spread evenly by number.
fn deposit(count: usize, seed: u64) -> Result<Vec<Disk>, Failure> {
    let mut chance = Chance::new(seed);
    let more = (count as f64 / (1.0 - TAKEN_OFF)).ceil() as usize;
    let radii: Vec<f64> = (0..more).map(|_| 0.5 * chance.between(DIAMETERS[0], DIAMETERS[1])).collect();
    let area = radii.iter().map(|radius| PI * radius * radius).sum::<f64>() * count as f64 / more as f64;
    let width = (area / (SOLID * ASPECT_RATIO)).sqrt();
    let deposit = ballistic(&radii, width, Sides::Walls, seed).map_err(|e| Failure::Io(e.to_string()))?;
    let disks = deposit.positions.into_iter().zip(radii);
    let mut disks: Vec<Disk> =
        disks.map(|(position, radius)| Disk { position, velocity: DVec2::ZERO, spin: 0.0, radius }).collect();
    disks.sort_by(|a, b| (a.position.y + a.radius).total_cmp(&(b.position.y + b.radius)));
    disks.truncate(count);
    Ok(disks)
}

/// A state between floor and left wall, ready to be timed.
///
/// # Errors
/// When a disk is out of range.
pub(super) fn simulation(disks: &[Disk]) -> Result<Dem2, Failure> {
    let wrong = |error: granular_dem::SetupError| Failure::Io(format!("state: {error}"));
    let mut materials = Materials::new();
    let material = Material { restitution: 0.75, damping_ratio: 0.0, friction: 0.53, ..Material::default() };
    let glass = materials.add(material).map_err(wrong)?;
    let grain =
        |disk: &Disk| Grain::at(disk.position, disk.radius, glass).moving(disk.velocity).turning(disk.spin);
    let plane = |name, normal| Wall::plane(name, DVec2::ZERO, normal, glass).map_err(wrong);
    let walls = vec![plane("floor", DVec2::Y)?, plane("left", DVec2::X)?];
    let grains = disks.iter().map(grain).collect();
    let gravity = DVec2::new(0.0, -GRAVITY);
    Dem2::new(Setup { materials, grains, walls, gravity, options: Options::default() }).map_err(wrong)
}

/// Reads a state.
///
/// # Errors
/// When the file cannot be read, or a row is neither `x y vx vy omega r` nor `x y r`.
pub(super) fn read(path: &Path) -> Result<Vec<Disk>, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::io(path.display(), error))?;
    let rows = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    rows.map(|(index, line)| {
        disk(line).ok_or_else(|| {
            let place = format!("{}, line {}", path.display(), index + 1);
            Failure::io(place, "expected the numbers `x y vx vy omega r` or `x y r`")
        })
    })
    .collect()
}

fn disk(line: &str) -> Option<Disk> {
    let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    match numbers[..] {
        [x, y, radius] => Some(Disk { position: DVec2::new(x, y), velocity: DVec2::ZERO, spin: 0.0, radius }),
        [x, y, vx, vy, spin, radius] => {
            Some(Disk { position: DVec2::new(x, y), velocity: DVec2::new(vx, vy), spin, radius })
        }
        _ => None,
    }
}

/// Writes a state, with digits that give the same numbers back.
///
/// # Errors
/// When the file cannot be written.
pub(super) fn write(disks: &[Disk], path: &Path) -> Result<(), Failure> {
    let mut text = String::new();
    for Disk { position, velocity, spin, radius } in disks {
        let _ = writeln!(
            text,
            "{:e} {:e} {:e} {:e} {spin:e} {radius:e}",
            position.x, position.y, velocity.x, velocity.y
        );
    }
    granular_io::write_atomically(path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_comes_back_as_it_was_written() {
        let disks = falling(60).unwrap();
        assert!(disks.iter().any(|disk| disk.velocity.length() > 0.05));
        let path = std::env::temp_dir().join(format!("granular-state-{}.txt", std::process::id()));
        write(&disks, &path).unwrap();
        let back = read(&path);
        std::fs::remove_file(&path).unwrap();
        assert_eq!(back.unwrap(), disks);
        assert_eq!(disk("1 2 3").map(|disk| disk.radius), Some(3.0));
        assert_eq!(disk("1 2 3 4"), None);
    }
}
