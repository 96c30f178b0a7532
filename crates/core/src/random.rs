//! Random numbers that a seed fixes: SplitMix64 \[Steele2014\], as a stream and as a table.
//!
//! What comes and goes while a simulation runs takes its numbers from the [table](uniform_at), by the number of the item:
//! there is no random state to save, and no order in which they must be drawn. Samples of grains are drawn by
//! `granular-packing` from ChaCha8.

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The 53 highest bits as a number in [0, 1).
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * 2.0_f64.powi(-53)
}

/// A number in [0, 1) for a seed and the place in a table of numbers: that of draw `draw` for item `item`.
pub fn uniform_at(seed: u64, item: u64, draw: u64) -> f64 {
    unit(mix(
        mix(mix(seed.wrapping_add(GOLDEN)).wrapping_add(item)).wrapping_add(GOLDEN.wrapping_mul(draw + 1))
    ))
}

/// A stream of random numbers that a seed fixes.
#[derive(Clone, Debug)]
pub struct Chance(u64);

impl Chance {
    /// The stream of a seed, from its start.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        unit(mix(self.0))
    }

    /// Uniform between two values.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(values: &[f64]) {
        let count = values.len() as f64;
        assert!(values.iter().all(|value| (0.0..1.0).contains(value)));
        let mean = values.iter().sum::<f64>() / count;
        let square = values.iter().map(|value| value * value).sum::<f64>() / count;
        assert!((mean - 0.5).abs() < 0.01 && (square - 1.0 / 3.0).abs() < 0.01, "{mean} {square}");
    }

    #[test]
    fn numbers_are_uniform() {
        let mut chance = Chance::new(7);
        check(&(0..10_000).map(|_| chance.uniform()).collect::<Vec<_>>());
        check(&(0..10_000).map(|item| uniform_at(7, item, 0)).collect::<Vec<_>>());
        check(&(0..10_000).map(|draw| uniform_at(7, 3, draw)).collect::<Vec<_>>());
    }

    /// The first numbers of SplitMix64 for the seed 1234567, from its reference implementation.
    #[test]
    fn the_stream_is_that_of_the_reference() {
        let mut chance = Chance::new(1_234_567);
        for bits in [6_457_827_717_110_365_317_u64, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423] {
            assert_eq!(chance.uniform(), unit(bits));
        }
    }

    /// A change of these bits would change every scene in which grains come in.
    #[test]
    fn the_table_is_fixed() {
        let found =
            [(0, 0, 0), (1, 2, 3), (u64::MAX, 1 << 40, 7)].map(|(a, b, c)| uniform_at(a, b, c).to_bits());
        assert_eq!(found, [4_599_761_431_544_892_160, 4_606_451_604_777_505_789, 4_602_059_909_987_810_354]);
    }
}
