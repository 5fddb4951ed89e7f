//! The grid and which body fills each cell.

use crate::assemble::Faults;
use crate::case::Base;
use crate::grid::{Grid, Spacing, faces, wanted};
use crate::material::GAS;
use crate::scene::{Body, Profile, Scene, Shape, Sides, SpacingScene};

/// Most cells of a scene.
const MOST_CELLS: usize = 4_000_000;

/// Shortest and longest edge of a domain \[m\]: areas and volumes stay numbers.
const EDGE: [f64; 2] = [1e-9, 1e4];

/// Grid and materials.
pub(crate) struct Layout {
    pub(crate) grid: Grid,
    pub(crate) material: Vec<usize>,
}

impl Layout {
    /// Bodies in the order of their names; body `n` is material `n + 1`.
    pub(crate) fn bodies(scene: &Scene) -> Vec<(&String, &Body)> {
        scene.bodies.iter().collect()
    }

    pub(crate) fn new(scene: &Scene, faults: &mut Faults) -> Option<Self> {
        let (r, z) = (scene.domain.r_m, scene.domain.z_m);
        if !(r[0] >= 0.0 && r[1] > r[0]) {
            faults.add(
                "/domain/r_m",
                format!("{r:?} m does not rise from 0 or more"),
            );
            return None;
        }
        if z[1] <= z[0] {
            faults.add("/domain/z_m", format!("{z:?} m does not rise"));
            return None;
        }
        for (at, span) in [("/domain/r_m", r), ("/domain/z_m", z)] {
            let reach = span[0].abs().max(span[1].abs());
            if span[1] - span[0] < EDGE[0] || reach > EDGE[1] {
                let [least, most] = EDGE;
                let what = format!(
                    "{span:?} m is out of range: at least {least:e} m long, at most to {most:e} m"
                );
                faults.add(at, what);
                return None;
            }
        }
        let (mut r_breaks, mut z_breaks) = (r.to_vec(), z.to_vec());
        rings(scene, [r, z], [&mut r_breaks, &mut z_breaks], faults);
        spans(scene, [r, z], [&mut r_breaks, &mut z_breaks], faults);
        let r_spacing = spacing(&scene.grid.r, "/grid/r", faults)?;
        let z_spacing = spacing(&scene.grid.z, "/grid/z", faults)?;
        let (r_breaks, z_breaks) = (tidy(r_breaks, r), tidy(z_breaks, z));
        let number = [
            wanted(&r_breaks, &r_spacing).ceil(),
            wanted(&z_breaks, &z_spacing).ceil(),
        ];
        // Whole cells between two faces are less than one more than wanted.
        let slack = 1.0 + (r_breaks.len() + z_breaks.len()) as f64;
        if number.iter().any(|n| *n + slack > MOST_CELLS as f64)
            || number[0] * number[1] > MOST_CELLS as f64
        {
            faults.add("/grid", too_many(number));
            return None;
        }
        let rf = faces(&r_breaks, &r_spacing);
        let zf = faces(&z_breaks, &z_spacing);
        let (nr, nz) = (rf.len() - 1, zf.len() - 1);
        if nr < 2 || nz < 2 {
            let what = format!("gives {nr} x {nz} cells; wanted are 2 x 2 at least");
            faults.add("/grid", what);
            return None;
        }
        let grid = Grid::new(rf, zf);
        let material = fill(scene, &grid, faults);
        Some(Self { grid, material })
    }

    pub(crate) fn is_gas(&self, k: usize) -> bool {
        self.material[k] == GAS
    }

    pub(crate) fn place(&self, k: usize) -> String {
        let (i, j) = (k % self.grid.nr, k / self.grid.nr);
        format!(
            "r = {:.4e} m, z = {:.4e} m",
            self.grid.rc[i], self.grid.zc[j]
        )
    }

    /// The body of `material`, if there is room above it on the axis.
    pub(crate) fn base(&self, material: usize, bodies: &[(&String, &Body)]) -> Option<Base> {
        let grid = &self.grid;
        let last = |i: usize| {
            let mut rows = (0..grid.nz).rev();
            rows.find(|j| self.material[grid.cell(i, *j)] == material)
        };
        let above = |i: usize| last(i).map(|j| j + 1).filter(|j| *j < grid.nz);
        let mut base = Base {
            material,
            above: (0..grid.nr).map(above).collect(),
            curve: None,
        };
        if let Shape::Profile(profile) = &bodies[material - 1].1.shape
            && base.is_deformed()
        {
            base.curve.clone_from(&profile.top);
        }
        base.above[0].is_some().then_some(base)
    }

    /// The lowest material on the axis that `has`.
    pub(crate) fn lowest(&self, has: impl Fn(usize) -> bool) -> Option<usize> {
        let column = (0..self.grid.nz).map(|j| self.material[self.grid.cell(0, j)]);
        column.into_iter().find(|m| has(*m))
    }
}

/// Why so many cells are refused, and how much coarser they would have to be.
fn too_many([nr, nz]: [f64; 2]) -> String {
    let factor = (nr * nz / MOST_CELLS as f64).sqrt();
    let advice = if factor.is_finite() && nr.max(nz) < MOST_CELLS as f64 {
        format!(": spacings {factor:.1} times as large would do")
    } else {
        String::new()
    };
    format!("asks for {nr:.4e} x {nz:.4e} cells; at most {MOST_CELLS} in all{advice}")
}

fn inside(at: &str, span: [f64; 2], domain: [f64; 2], faults: &mut Faults) {
    let slack = 1e-9 * (domain[1] - domain[0]);
    if span[1] <= span[0] || span[0] < domain[0] - slack || span[1] > domain[1] + slack {
        faults.add(
            at,
            format!("{span:?} m does not rise within the domain, {domain:?} m"),
        );
    }
}

fn spacing(scene: &SpacingScene, at: &str, faults: &mut Faults) -> Option<Spacing> {
    let found = match scene {
        SpacingScene::Uniform(value) => Spacing::uniform(*value),
        SpacingScene::Graded(g) => Spacing {
            at: g.at_m.clone(),
            spacing: g.spacing_m.clone(),
        },
    };
    if found.at.len() != found.spacing.len() || found.at.is_empty() {
        faults.add(at, "wants as many positions as spacings, one or more");
        return None;
    }
    if found.at.windows(2).any(|w| w[1] <= w[0]) {
        faults.add(&format!("{at}/at_m"), "does not rise");
        return None;
    }
    if found.spacing.iter().any(|s| *s <= 0.0) {
        faults.add(at, "spacings are above 0 m");
        return None;
    }
    Some(found)
}

/// Edges of the rings of bodies become faces.
fn rings(scene: &Scene, [r, z]: [[f64; 2]; 2], breaks: [&mut Vec<f64>; 2], faults: &mut Faults) {
    let [r_breaks, z_breaks] = breaks;
    for (name, body) in &scene.bodies {
        if let Shape::Profile(profile) = &body.shape {
            profile_breaks(
                name,
                profile,
                [r, z],
                [&mut *r_breaks, &mut *z_breaks],
                faults,
            );
        }
        for (n, ring) in body.shape.rings().iter().enumerate() {
            let at = match &body.shape {
                Shape::Rings(_) => format!("/bodies/{name}/shape/rings/{n}"),
                _ => format!("/bodies/{name}/shape/ring"),
            };
            inside(&format!("{at}/r_m"), ring.r_m, r, faults);
            inside(&format!("{at}/z_m"), ring.z_m, z, faults);
            r_breaks.extend(ring.r_m);
            z_breaks.extend(ring.z_m);
        }
    }
}

/// The ends of a body with a curved top, its bottom, and its height at the outer end become faces.
fn profile_breaks(
    name: &str,
    profile: &Profile,
    [r, z]: [[f64; 2]; 2],
    [r_breaks, z_breaks]: [&mut Vec<f64>; 2],
    faults: &mut Faults,
) {
    let at = format!("/bodies/{name}/shape/profile");
    let Some(top) = &profile.top else {
        let what =
            "is missing, and so is the input \"surface\" that would tell it: --input surface=FILE";
        faults.add(&format!("{at}/top"), what);
        return;
    };
    if let Some(what) = top.fault() {
        faults.add(&format!("{at}/top"), what);
        return;
    }
    inside(&format!("{at}/r_m"), profile.r_m, r, faults);
    for height in &top.z_m {
        inside(&format!("{at}/top"), [profile.bottom_m, *height], z, faults);
    }
    r_breaks.extend(profile.r_m);
    z_breaks.extend([profile.bottom_m, top.height(profile.r_m[1])]);
}

/// Ends of the parts of sides become faces.
fn spans(scene: &Scene, domain: [[f64; 2]; 2], breaks: [&mut Vec<f64>; 2], faults: &mut Faults) {
    let [r_breaks, z_breaks] = breaks;
    let mut take = |at: &str, along_r: bool, span: Option<[f64; 2]>| {
        if let Some(span) = span {
            inside(at, span, domain[usize::from(!along_r)], faults);
            if along_r {
                r_breaks.extend(span)
            } else {
                z_breaks.extend(span)
            }
        }
    };
    if let Some(c) = &scene.current {
        each(&c.edges, "/current/edges", |at, r, e| take(at, r, e.over_m));
    }
    if let Some(f) = &scene.flow {
        each(&f.edges, "/flow/edges", |at, r, e| take(at, r, e.over_m));
    }
    if let Some(h) = &scene.heat {
        each(&h.edges, "/heat/edges", |at, r, e| take(at, r, e.over_m));
    }
    if let Some(v) = &scene.vapour {
        each(&v.edges, "/vapour/edges", |at, r, e| take(at, r, e.over_m));
    }
}

/// Visits every condition with its path and whether its side runs along the radius.
pub(crate) fn each<T>(sides: &Sides<T>, at: &str, mut visit: impl FnMut(&str, bool, &T)) {
    let all = [
        ("inner", false, &sides.inner),
        ("outer", false, &sides.outer),
        ("bottom", true, &sides.bottom),
        ("top", true, &sides.top),
    ];
    for (name, along_r, list) in all {
        for (n, edge) in list.iter().enumerate() {
            visit(&format!("{at}/{name}/{n}"), along_r, edge);
        }
    }
}

/// Sorted breaks within the domain, without those that coincide.
fn tidy(mut breaks: Vec<f64>, domain: [f64; 2]) -> Vec<f64> {
    let slack = 1e-9 * (domain[1] - domain[0]);
    breaks.retain(|b| *b >= domain[0] && *b <= domain[1]);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|a, b| (*a - *b).abs() <= slack);
    breaks
}

fn fill(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Vec<usize> {
    let mut material = vec![GAS; grid.len()];
    for (n, (name, body)) in scene.bodies.iter().enumerate() {
        let mut filled = 0;
        for j in 0..grid.nz {
            for i in 0..grid.nr {
                let (r, z) = (grid.rc[i], grid.zc[j]);
                if !body.shape.holds(r, z) {
                    continue;
                }
                let k = grid.cell(i, j);
                if material[k] != GAS {
                    let other = scene.bodies.keys().nth(material[k] - 1);
                    let other = other.map_or("", String::as_str);
                    faults.add(
                        &format!("/bodies/{name}/shape"),
                        format!("overlaps \"{other}\""),
                    );
                    return material;
                }
                material[k] = n + 1;
                filled += 1;
            }
        }
        if filled == 0 {
            faults.add(
                &format!("/bodies/{name}/shape"),
                "holds no cell of the grid",
            );
        }
    }
    material
}
