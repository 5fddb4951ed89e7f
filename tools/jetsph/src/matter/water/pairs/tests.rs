//! Sums over pairs beside a plain search, and the bits they have.

use super::*;
use kernels::CubicSpline;

const REACH: f64 = 0.34;

/// Pulls by what differs, and adds what is alike.
struct Trial;

impl Exchange<1> for Trial {
    fn pair<N: Number>(&self, pair: &Pair<N>) -> [[N; 4]; 1] {
        let [x, y, z] = pair.dx;
        let scale = pair.slope * pair.square * (pair.own.value + pair.other.value);
        [[scale * x, scale * y, scale * z, scale * pair.parting()]]
    }

    fn weights(own: f64, other: f64) -> [[f64; 4]; 2] {
        let both = own * other;
        [[both; 4], [-both, -both, -both, both]]
    }
}

fn cloud(n: usize, span: f64) -> Vec<Seen> {
    let noise = |k: usize| shapes::jitter::signed(0, k as u64);
    let each = (0..n).map(|a| Seen {
        x: [0, 1, 2].map(|k| span * noise(8 * a + k)),
        u: [3, 4, 5].map(|k| noise(8 * a + k)),
        volume: 2.0 + noise(8 * a + 6),
        value: noise(8 * a + 7),
    });
    each.collect()
}

fn totals(seen: &[Seen]) -> Vec<[f64; 4]> {
    let places: Vec<[f64; 3]> = seen.iter().map(|seen| seen.x).collect();
    let (mut pairs, mut grid) = (Pairs::default(), Grid::new(0.5 * REACH));
    grid.bin(&places);
    pairs.find(&places, &grid, REACH);
    pairs.look(seen);
    pairs.sum(&CubicSpline::<3>::new(0.15), &Trial);
    let total = |a: usize| -> [[f64; 4]; 1] { pairs.total(a) };
    (0..seen.len()).map(|a| total(a)[0]).collect()
}

#[test]
fn each_has_what_all_others_give_it() {
    let (seen, kernel) = (cloud(1500, 1.0), CubicSpline::<3>::new(0.15));
    let side = |seen: &Seen| Side {
        x: seen.x,
        u: seen.u,
        value: seen.value,
        aid: [0.0; 3],
    };
    for (a, found) in totals(&seen).into_iter().enumerate() {
        let (mut sum, mut size) = ([0.0; 4], 0.0_f64);
        for b in (0..seen.len()).filter(|b| *b != a) {
            let [part] = Trial.pair(&Pair::of(&kernel, side(&seen[a]), side(&seen[b])));
            let part = part.map(|x| x * seen[a].volume * seen[b].volume);
            (0..4).for_each(|k| sum[k] += part[k]);
            size += part.iter().map(|x| x.abs()).sum::<f64>();
        }
        let off = (0..4)
            .map(|k| (found[k] - sum[k]).abs())
            .fold(0.0, f64::max);
        assert!(off <= 1e-13 * size, "{a}: {found:?} {sum:?}");
    }
}

#[test]
fn what_one_gains_the_other_loses() {
    let found = totals(&cloud(3000, 1.0));
    let sum = |k: usize| found.iter().map(|x| x[k]).sum::<f64>().abs();
    let size: f64 = found.iter().map(|x| x[0].abs()).sum();
    assert!(size > 0.0 && sum(0) + sum(1) + sum(2) < 1e-13 * size);
}

#[test]
fn bits_do_not_depend_on_threads() {
    let seen = cloud(5000, 1.0);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let found = pool.build().unwrap().install(|| totals(&seen));
        found.into_iter().map(|x| x.map(f64::to_bits))
    };
    assert!(on(1).eq(on(2)) && on(1).eq(on(5)));
}

#[test]
fn who_is_alone_is_given_nothing() {
    assert!(totals(&[]).is_empty());
    let none = totals(&cloud(40, 100.0));
    assert!(none.as_flattened().iter().all(|x| x.abs() <= 0.0));
}
