//! Obstacles drawn as images.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3};
use granular_lbm::*;

const SIDE: usize = 40;
/// Centre and radius of the disk that is drawn, in pixels.
const CENTRE: DVec2 = DVec2::new(19.3, 20.8);
const RADIUS: f64 = 12.4;
/// Edge of a pixel and lowest corner.
const PIXEL: f64 = 2e-3;
const LOW: DVec2 = DVec2::new(0.1, -0.2);

fn pixels() -> impl Iterator<Item = DVec2> {
    (0..SIDE * SIDE).map(|i| DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) + 0.5)
}

/// A black disk on white with soft edges: brightness by the share of a pixel outside.
fn soft_disk() -> Vec<f64> {
    let parts = || (0..256).map(|i| DVec2::new((i % 16) as f64, (i / 16) as f64) / 16.0 - 15.0 / 32.0);
    let outside = |pixel: DVec2| parts().filter(|part| (pixel + *part - CENTRE).length() > RADIUS).count();
    pixels().map(|pixel| outside(pixel) as f64 / 256.0).collect()
}

fn ball() -> Ball<D2> {
    Ball { centre: LOW + CENTRE * PIXEL, radius: RADIUS * PIXEL }
}

/// Relative error of the area, and the largest distance \[pixels\] between the contours along lattice links that
/// cross both.
fn departure(disk: &impl SolidShape<D2>) -> [f64; 2] {
    let ball = ball();
    let fine = 0.05 * PIXEL;
    let count = (0..800 * 800)
        .filter(|i| disk.contains(LOW + (DVec2::new((i % 800) as f64, (i / 800) as f64) + 0.5) * fine));
    let area = count.count() as f64 * fine * fine / (std::f64::consts::PI * ball.radius * ball.radius) - 1.0;
    let mut largest = 0.0_f64;
    for way in D2Q9::VELOCITIES.iter().skip(1) {
        let way = DVec2::new(f64::from(way[0]), f64::from(way[1])) * 3.0 * PIXEL;
        for outside in pixels().map(|pixel| LOW + pixel * PIXEL) {
            let inside = outside + way;
            // Links that come in steeply: a crossing moves by the distance over the cosine.
            let cosine = (ball.centre - inside).normalize().dot(way.normalize());
            let is_cut = |shape: &dyn SolidShape<D2>| !shape.contains(outside) && shape.contains(inside);
            if is_cut(disk) && is_cut(&ball) && cosine > 0.7 {
                let apart = disk.crossing(outside, inside) - ball.crossing(outside, inside);
                largest = largest.max(apart.abs() * way.length() * cosine / PIXEL);
            }
        }
    }
    [area, largest]
}

#[test]
fn a_disk_drawn_with_soft_edges_is_the_ball_within_a_fraction_of_a_pixel() {
    let soft = Bitmap::of_brightness(LOW, PIXEL, [SIDE, SIDE], &soft_disk(), Solid::Darker(0.5)).unwrap();
    let bright: Vec<f64> = soft_disk().iter().map(|value| 1.0 - value).collect();
    let other = Bitmap::of_brightness(LOW, PIXEL, [SIDE, SIDE], &bright, Solid::Brighter(0.5)).unwrap();
    let solid: Vec<bool> = pixels().map(|pixel| (pixel - CENTRE).length() <= RADIUS).collect();
    let hard = Bitmap::new(LOW, PIXEL, [SIDE, SIDE], &solid).unwrap();
    let (soft, other, hard) = (departure(&soft), departure(&other), departure(&hard));
    assert!(soft[0].abs() < 5e-3 && soft[1] < 0.1, "{soft:?}");
    assert!((other[0] - soft[0]).abs() < 1e-3, "{other:?}, {soft:?}");
    assert!(hard[0].abs() < 1e-2 && hard[1] < 0.6, "{hard:?}");
}

#[test]
fn a_bitmap_ends_where_the_image_ends_and_one_pixel_does() {
    let one = Bitmap::new(DVec2::ZERO, 1.0, [1, 1], &[true]).unwrap();
    assert!(one.contains(DVec2::new(0.01, 0.99)) && !one.contains(DVec2::new(1.01, 0.5)));
    assert!((one.crossing(DVec2::new(-0.5, 0.5), DVec2::new(0.5, 0.5)) - 0.5).abs() < 1e-12);
    let column = Bitmap::new(DVec2::ZERO, 1.0, [1, 3], &[true, false, true]).unwrap();
    assert!(column.contains(DVec2::new(0.5, 0.9)) && !column.contains(DVec2::new(0.5, 1.1)));
    assert!(!column.contains(DVec2::new(f64::NAN, 0.5)));
}

#[test]
fn an_extruded_bitmap_is_a_cylinder_and_slows_a_stream_as_one() {
    let force = |shape: &dyn Fn(&mut Setup<D3>)| {
        let mut setup = Setup::<D3>::new([40, 40, 3], PIXEL, 1e-6, 0.8);
        setup.origin = LOW.extend(0.0);
        setup.acceleration = DVec3::new(1e-9, 0.0, 0.0);
        shape(&mut setup);
        let mut lbm = Lbm3::new(setup).unwrap();
        let dt = lbm.setup().time_step;
        granular_core::Solver::advance(&mut lbm, dt, 3000).unwrap();
        (lbm.force_on(0).x, lbm.flow([0, 0, 1]).unwrap().velocity.x)
    };
    let (from, to) = (-1.0, 1.0);
    let disk = Bitmap::of_brightness(LOW, PIXEL, [SIDE, SIDE], &soft_disk(), Solid::Darker(0.5)).unwrap();
    let drawn = force(&|s| s.obstacles.push(Obstacle::new("a", Extruded { shape: disk.clone(), from, to })));
    let ball = force(&|s| s.obstacles.push(Obstacle::new("a", Extruded { shape: ball(), from, to })));
    assert!(
        (drawn.0 / ball.0 - 1.0).abs() < 0.01 && (drawn.1 / ball.1 - 1.0).abs() < 0.01,
        "{drawn:?} {ball:?}"
    );
}

#[test]
fn images_that_make_no_sense_are_refused() {
    let what = |result: Result<Bitmap, SetupError>| result.unwrap_err().what;
    assert_eq!(what(Bitmap::new(LOW, 1.0, [2, 2], &[true; 3])), "pixels");
    assert_eq!(what(Bitmap::new(LOW, 1.0, [0, 2], &[])), "pixels");
    assert_eq!(what(Bitmap::new(LOW, 0.0, [1, 1], &[true])), "edge of a pixel");
    assert_eq!(what(Bitmap::new(DVec2::NAN, 1.0, [1, 1], &[true])), "corner of an image");
    let of = |value, solid| what(Bitmap::of_brightness(LOW, 1.0, [1, 1], &[value], solid));
    assert_eq!(of(f64::NAN, Solid::Darker(0.5)), "brightness of a pixel");
    assert_eq!(of(0.0, Solid::Brighter(1.0)), "brightness of a solid");
}

#[cfg(feature = "png")]
mod png_files {
    use super::*;
    use std::io::Cursor;

    /// A picture as bytes of a file, from samples of its pixels, the highest row first.
    fn file(color: png::ColorType, samples: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, SIDE as u32, SIDE as u32);
        encoder.set_color(color);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header().unwrap().write_image_data(samples).unwrap();
        bytes
    }

    /// Eight bits of the disk, the highest row first.
    fn rows() -> Vec<u8> {
        let disk: Vec<u8> = soft_disk().iter().map(|value| (value * 255.0).round() as u8).collect();
        disk.chunks(SIDE).rev().flatten().copied().collect()
    }

    #[test]
    fn a_disk_in_a_file_is_the_ball_whatever_the_colours() {
        let color = |pixel: fn(u8) -> Vec<u8>| rows().into_iter().flat_map(pixel).collect::<Vec<u8>>();
        let files = [
            file(png::ColorType::Grayscale, &rows()),
            file(png::ColorType::Rgb, &color(|light| vec![light; 3])),
            file(png::ColorType::Rgba, &color(|light| vec![0, 0, 0, 255 - light])),
            file(png::ColorType::GrayscaleAlpha, &color(|light| vec![light, 255])),
        ];
        for file in files {
            let disk = Bitmap::from_png(Cursor::new(file), LOW, PIXEL, Solid::Darker(0.5)).unwrap();
            let [area, distance] = departure(&disk);
            assert!(area.abs() < 5e-3 && distance < 0.1, "{area} {distance}");
        }
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let whole = file(png::ColorType::Grayscale, &rows());
        for bytes in [&b""[..], b"not a picture", &whole[..whole.len() / 2]] {
            let error = Bitmap::from_png(Cursor::new(bytes), LOW, PIXEL, Solid::Darker(0.5)).unwrap_err();
            assert_eq!(error.what, "image", "{error}");
        }
    }
}
