//! Few colours for many pixels: median cut (Heckbert 1982).
//!
//! Colours are sorted into 64^3 bins; boxes of bins are halved at the median of their longest side
//! until there are as many as the palette holds. Pictures of shaded particles become a third as
//! large, and the eye sees no difference.

use std::collections::BTreeMap;

use super::colour::Rgb;

/// Most colours of a palette.
pub(crate) const MOST: usize = 256;
/// Bits per channel of a bin.
const BITS: u32 = 6;

/// Colours and, for each pixel, which.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Indexed {
    /// At most 256 colours.
    pub(crate) colours: Vec<[u8; 3]>,
    /// Index of the colour of each pixel.
    pub(crate) pixels: Vec<u8>,
}

/// A bin that is not empty: its place, number of pixels, sum of their colours.
#[derive(Debug, Clone, Copy)]
struct Bin {
    at: [u8; 3],
    count: u64,
    sum: [u64; 3],
}

/// Gives every pixel the mean colour of its box, of so many boxes.
pub(crate) fn index(pixels: &[Rgb], most: usize) -> Indexed {
    let bytes: Vec<[u8; 3]> = pixels
        .iter()
        .map(|p| p.map(|part| (part * 255.0).round().clamp(0.0, 255.0) as u8))
        .collect();
    let mut bins: BTreeMap<[u8; 3], Bin> = BTreeMap::new();
    for colour in &bytes {
        let at = place(*colour);
        let empty = Bin {
            at,
            count: 0,
            sum: [0; 3],
        };
        let bin = bins.entry(at).or_insert(empty);
        bin.count += 1;
        for (sum, part) in bin.sum.iter_mut().zip(colour) {
            *sum += u64::from(*part);
        }
    }
    let boxes = cut(bins.into_values().collect(), most.min(MOST));
    let mut which = BTreeMap::new();
    for (n, bins) in boxes.iter().enumerate() {
        for bin in bins {
            which.insert(bin.at, n as u8);
        }
    }
    Indexed {
        colours: boxes.iter().map(|bins| mean(bins)).collect(),
        pixels: bytes
            .iter()
            .map(|colour| which.get(&place(*colour)).copied().unwrap_or(0))
            .collect(),
    }
}

fn place(colour: [u8; 3]) -> [u8; 3] {
    colour.map(|part| part >> (8 - BITS))
}

fn cut(bins: Vec<Bin>, most: usize) -> Vec<Vec<Bin>> {
    let mut boxes = vec![bins];
    while boxes.len() < most {
        // The box whose pixels suffer most: far apart above all, then many. Were it many above all,
        // small things such as colour bars would lose their colours to large plain faces.
        let worst = boxes
            .iter()
            .enumerate()
            .max_by_key(|(_, bins)| {
                let (_, width) = longest(bins);
                u64::from(width).pow(3) * bins.iter().map(|b| b.count).sum::<u64>()
            })
            .map(|(n, bins)| (n, longest(bins)));
        let Some((n, (side, width))) = worst else {
            break;
        };
        if width == 0 {
            break;
        }
        let (low, high) = halve(boxes.swap_remove(n), side);
        boxes.extend([low, high]);
    }
    boxes
}

/// Longest side of a box and its length in bins.
fn longest(bins: &[Bin]) -> (usize, u8) {
    let width = |side: usize| {
        let places = || bins.iter().map(|b| b.at[side]);
        places().max().unwrap_or(0) - places().min().unwrap_or(0)
    };
    let sides = [0, 1, 2].map(|side| (side, width(side)));
    sides.into_iter().max_by_key(|s| s.1).unwrap_or((0, 0))
}

/// Two boxes with about the same number of pixels, neither empty.
fn halve(mut bins: Vec<Bin>, side: usize) -> (Vec<Bin>, Vec<Bin>) {
    bins.sort_by_key(|b| (b.at[side], b.at));
    let half = bins.iter().map(|b| b.count).sum::<u64>() / 2;
    let mut passed = 0;
    let median = bins.iter().position(|b| {
        passed += b.count;
        passed > half
    });
    let at = median.unwrap_or(0).clamp(1, bins.len() - 1);
    let high = bins.split_off(at);
    (bins, high)
}

fn mean(bins: &[Bin]) -> [u8; 3] {
    let count = bins.iter().map(|b| b.count).sum::<u64>().max(1);
    [0, 1, 2].map(|k| {
        let sum = bins.iter().map(|b| b.sum[k]).sum::<u64>();
        ((sum + count / 2) / count).min(255) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_come_back_as_they_were() {
        let pixels = [[1.0, 1.0, 1.0], [0.0, 0.0, 1.0], [0.2, 0.4, 0.6]].repeat(7);
        let found = index(&pixels, MOST);
        assert_eq!(found.colours.len(), 3);
        for (pixel, n) in pixels.iter().zip(&found.pixels) {
            let bytes = pixel.map(|p: f32| (p * 255.0).round() as u8);
            assert_eq!(found.colours[usize::from(*n)], bytes);
        }
    }

    #[test]
    fn many_colours_stay_close_to_what_they_were() {
        let pixels: Vec<Rgb> = (0..64 * 64)
            .map(|n| {
                let (a, b) = ((n % 64) as f32 / 63.0, (n / 64) as f32 / 63.0);
                [a, b, 0.5 * (a + b)]
            })
            .collect();
        let found = index(&pixels, MOST);
        assert_eq!(found.colours.len(), MOST);
        let worst = pixels.iter().zip(&found.pixels).map(|(pixel, n)| {
            let colour = found.colours[usize::from(*n)];
            let off = |k: usize| (pixel[k] * 255.0 - f32::from(colour[k])).abs();
            off(0).max(off(1)).max(off(2))
        });
        assert!(worst.fold(0.0_f32, f32::max) < 20.0);
    }
}
