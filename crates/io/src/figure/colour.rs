//! Colours: a palette that colour-blind readers can tell apart, and maps for scalars.

/// Red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Colour(pub(super) [u8; 3]);

impl Colour {
    pub(super) const WHITE: Self = Self([255; 3]);
    pub(super) const TEXT: Self = Self([34; 3]);
    pub(super) const FAINT_TEXT: Self = Self([90; 3]);
    pub(super) const FRAME: Self = Self([70; 3]);
    pub(super) const GRID: Self = Self([226; 3]);
    pub(super) const FINE_GRID: Self = Self([241; 3]);
    /// Grains and cells without a value.
    pub(super) const NEUTRAL: Self = Self([214; 3]);
    /// Grains over a map: a sand that no colour of a map has.
    pub(super) const GRAIN: Self = Self([222, 200, 150]);

    /// A colour of the palette of Okabe and Ito without its yellow, which is too pale for lines on
    /// white; black is the last of eight.
    pub(super) fn of_series(index: usize) -> Self {
        const PALETTE: [u32; 8] =
            [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0x56b4e9, 0xe69f00, 0x7f7f7f, 0x000000];
        Self::from_hex(PALETTE[index % PALETTE.len()])
    }

    /// The map viridis at `share` in 0..=1, which is monotonic in lightness.
    pub(super) fn of_share(share: f64) -> Self {
        const VIRIDIS: [u32; 10] = [
            0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b,
            0xfde725,
        ];
        Self::between(&VIRIDIS, share)
    }

    /// Greys from light at 0 to dark at 1.
    pub(super) fn of_density(share: f64) -> Self {
        Self::between(&[0xf4f4f4, 0x3a3a3a], share)
    }

    /// The map RdBu of ColorBrewer from blue at 0 over white at one half to red at 1: it is as
    /// light at either side of the middle, and colour-blind readers can tell the sides apart.
    pub(super) fn of_signed_share(share: f64) -> Self {
        const BLUE_RED: [u32; 11] = [
            0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d,
            0xb2182b, 0x67001f,
        ];
        Self::between(&BLUE_RED, share)
    }

    fn between(colours: &[u32], share: f64) -> Self {
        let place = share.clamp(0.0, 1.0) * (colours.len() - 1) as f64;
        let index = (place as usize).min(colours.len() - 2);
        let part = place - index as f64;
        let (low, high) = (Self::from_hex(colours[index]).0, Self::from_hex(colours[index + 1]).0);
        Self(std::array::from_fn(|k| {
            (f64::from(low[k]) * (1.0 - part) + f64::from(high[k]) * part).round() as u8
        }))
    }

    fn from_hex(hex: u32) -> Self {
        let [_, red, green, blue] = hex.to_be_bytes();
        Self([red, green, blue])
    }

    pub(super) fn hex(self) -> String {
        let [red, green, blue] = self.0;
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}
