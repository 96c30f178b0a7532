//! A spacing of cells that divides all sides of a box.

use super::FIT;

/// Cells along the first side that are tried, beyond and below those of the spacing asked for, at most.
const TRIED: u64 = 20_000;
/// How far from the spacing asked for one is looked for.
const FARTHEST: f64 = 2.0;

/// What to do when `wanted` does not divide all `sizes` \[m\].
pub(super) fn advice(sizes: &[f64], wanted: f64) -> String {
    if let Some(found) = nearest(sizes, wanted) {
        return format!("{found} m divides all sides");
    }
    if !(wanted > 0.0 && wanted.is_finite()) {
        return String::new();
    }
    let cells = |size: &f64| (size / wanted).round().max(1.0);
    let fitting: Vec<String> =
        sizes.iter().map(|size| format!("{} m", short(cells(size) * wanted))).collect();
    format!("no spacing near it divides all sides; sides of {} would fit", fitting.join(" and "))
}

/// The spacing nearest to `wanted` that divides all sizes, within a factor of two.
fn nearest(sizes: &[f64], wanted: f64) -> Option<f64> {
    let first = *sizes.first()?;
    let cells = first / wanted;
    if !(wanted > 0.0 && cells.is_finite() && cells < 1e9) {
        return None;
    }
    let divides = |spacing: f64| {
        sizes.iter().all(|size| {
            let count = (size / spacing).round();
            count >= 1.0 && (size / spacing - count).abs() <= 0.1 * FIT * count
        })
    };
    let middle = cells.round().max(1.0) as u64;
    let candidates = (0..TRIED).flat_map(|away| [middle.saturating_sub(away), middle + away]);
    let mut best: Option<f64> = None;
    for count in candidates.filter(|count| *count > 0) {
        let spacing = short(first / count as f64);
        let off = |spacing: f64| (spacing / wanted).ln().abs();
        if off(spacing) > FARTHEST.ln() {
            continue;
        }
        if best.is_some_and(|best| off(best) <= off(spacing)) {
            // Further away on both sides there is nothing nearer.
            if count > 2 * middle {
                break;
            }
            continue;
        }
        if divides(spacing) {
            best = Some(spacing);
        }
    }
    best
}

/// A length with ten digits, so that it reads well.
pub(super) fn short(length: f64) -> f64 {
    format!("{length:.9e}").parse().unwrap_or(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_advice_divides_all_sides() {
        // A channel of 2.2 m by 0.41 m: whole parts of a hundredth divide both, seven millimetres neither.
        assert_eq!(nearest(&[2.2, 0.41], 7e-3), Some(5e-3));
        assert_eq!(nearest(&[1.1, 0.4], 7e-3), Some(short(0.1 / 14.0)));
        let text = advice(&[1.1, 0.4], 7e-3);
        let spacing: f64 = text.split(' ').next().unwrap().parse().unwrap();
        for size in [1.1, 0.4] {
            let count: f64 = size / spacing;
            assert!((count - count.round()).abs() < 1e-6, "{text}");
        }
        // Sides without a common measure get sides that have one.
        let text = advice(&[1.0, 2.0_f64.sqrt()], 0.1);
        assert!(text.contains("sides of 1 m and 1.4 m would fit"), "{text}");
        assert_eq!(nearest(&[1.0], 0.3), Some(short(1.0 / 3.0)));
        assert_eq!((nearest(&[1.0], 0.0), nearest(&[1.0], f64::NAN)), (None, None));
    }
}
