//! Colours and perceptual colour maps.

/// A colour in sRGB, each part in 0..1.
pub(crate) type Rgb = [f32; 3];

pub(crate) const WHITE: Rgb = [1.0, 1.0, 1.0];
pub(crate) const INK: Rgb = [0.13, 0.15, 0.18];
pub(crate) const FAINT: Rgb = [0.55, 0.58, 0.62];
/// Solid metal that has never been liquid.
pub(crate) const PLATE: Rgb = [0.70, 0.73, 0.76];
/// Metal that has been liquid and has frozen again.
pub(crate) const FROZEN: Rgb = [0.45, 0.60, 0.74];
/// Molten slag.
pub(crate) const SLAG: Rgb = hex(0xd6_2828);

/// A colour map, by ten anchors at equal distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Map {
    /// Dark violet to yellow; for hot things.
    Inferno,
    /// The part of inferno that stands out from grey metal.
    Molten,
    /// Blue to yellow; for speeds.
    Viridis,
    /// Blue below the middle, white there, red above it; for what goes both ways.
    BlueRed,
}

// Ten equidistant samples of matplotlib's maps, which are in the public domain (CC0).
const INFERNO: [u32; 10] = [
    0x00_0004, 0x1b_0c41, 0x4a_0c6b, 0x78_1c6d, 0xa5_2c60, 0xcf_4446, 0xed_6925, 0xfb_9b06,
    0xf7_d13d, 0xfc_ffa4,
];
const VIRIDIS: [u32; 10] = [
    0x44_0154, 0x48_2878, 0x3e_4989, 0x31_688e, 0x26_828e, 0x1f_9e89, 0x35_b779, 0x6e_ce58,
    0xb5_de2b, 0xfd_e725,
];

/// Blue and red of ColorBrewer's RdBu in ten steps (Brewer 2002), whose two middle ones are next to white.
const BLUE_RED: [u32; 10] = [
    0x05_3061, 0x21_66ac, 0x43_93c3, 0x92_c5de, 0xf2_f6f9, 0xfd_f6f2, 0xf4_a582, 0xd6_604d,
    0xb2_182b, 0x67_001f,
];

impl Map {
    /// Colour at `t`, which is clipped to 0..1.
    pub(crate) fn at(self, t: f64) -> Rgb {
        let t = if t.is_finite() {
            t.clamp(0.0, 1.0)
        } else {
            0.0
        };
        match self {
            Map::Inferno => between(&INFERNO, t),
            Map::Molten => between(&INFERNO, 0.30 + 0.68 * t),
            Map::Viridis => between(&VIRIDIS, t),
            Map::BlueRed => between(&BLUE_RED, t),
        }
    }
}

fn between(anchors: &[u32; 10], t: f64) -> Rgb {
    let place = t * (anchors.len() - 1) as f64;
    let low = (place as usize).min(anchors.len() - 2);
    mix(
        hex(anchors[low]),
        hex(anchors[low + 1]),
        (place - low as f64) as f32,
    )
}

/// The colour 0xRRGGBB.
pub(crate) const fn hex(code: u32) -> Rgb {
    [
        ((code >> 16) & 255) as f32 / 255.0,
        ((code >> 8) & 255) as f32 / 255.0,
        (code & 255) as f32 / 255.0,
    ]
}

/// `a` for `t` = 0, `b` for `t` = 1.
pub(crate) fn mix(a: Rgb, b: Rgb, t: f32) -> Rgb {
    let s = 1.0 - t;
    [
        a[0] * s + b[0] * t,
        a[1] * s + b[1] * t,
        a[2] * s + b[2] * t,
    ]
}

/// `colour` brighter or darker by `factor`.
pub(crate) fn shade(colour: Rgb, factor: f32) -> Rgb {
    colour.map(|part| (part * factor).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_start_and_end_at_their_anchors() {
        assert_eq!(Map::Viridis.at(0.0).to_vec(), hex(0x44_0154));
        assert_eq!(Map::Inferno.at(1.0).to_vec(), hex(0xfc_ffa4));
        assert_eq!(Map::Inferno.at(f64::NAN).to_vec(), hex(0x00_0004));
    }

    #[test]
    fn hot_is_lighter_than_cold() {
        let light = |c: Rgb| 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2];
        for map in [Map::Inferno, Map::Molten, Map::Viridis] {
            let steps: Vec<f32> = (0..=20)
                .map(|i| light(map.at(f64::from(i) / 20.0)))
                .collect();
            assert!(
                steps.windows(2).all(|w| w[1] >= w[0] - 1e-3),
                "{map:?} {steps:?}"
            );
        }
    }
}
