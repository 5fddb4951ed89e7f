//! Vectors in space, and where a shape stands: an origin and three axes at right angles.

/// A place or direction \[m\].
pub type Vector = [f64; 3];

/// The scalar product.
#[inline(always)]
#[must_use]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a . a`.
#[inline(always)]
#[must_use]
pub fn squared(a: Vector) -> f64 {
    dot(a, a)
}

/// `a + s b`.
#[inline(always)]
#[must_use]
pub fn along(a: Vector, s: f64, b: Vector) -> Vector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// `s a`.
#[inline(always)]
#[must_use]
pub fn scaled(s: f64, a: Vector) -> Vector {
    [s * a[0], s * a[1], s * a[2]]
}

/// `a - b`.
#[inline(always)]
#[must_use]
pub fn difference(a: Vector, b: Vector) -> Vector {
    along(a, -1.0, b)
}

/// Length \[m\].
#[inline(always)]
#[must_use]
pub fn length(a: Vector) -> f64 {
    squared(a).sqrt()
}

/// `|a - b|` \[m\].
#[inline(always)]
#[must_use]
pub fn distance(a: Vector, b: Vector) -> f64 {
    length(difference(a, b))
}

/// The unit vector along `a`; none of a vector without a length.
#[must_use]
pub fn unit(a: Vector) -> Option<Vector> {
    let size = length(a);
    (size > 0.0 && size.is_finite()).then(|| a.map(|x| x / size))
}

/// The direction of `a`, which must not be zero.
#[must_use]
pub fn direction(a: Vector) -> Vector {
    let scale = 1.0 / length(a);
    [scale * a[0], scale * a[1], scale * a[2]]
}

/// The vector product.
#[inline(always)]
#[must_use]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Axes of a shape in the scene's coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Origin of the shape \[m\].
    pub origin: Vector,
    /// Its own x, y, z as directions of the scene.
    pub axes: [Vector; 3],
}

impl Frame {
    /// The scene's own axes.
    pub const SCENE: Self = Self {
        origin: [0.0; 3],
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    };

    /// The place with own coordinates `q` in the scene.
    #[must_use]
    pub fn place(&self, q: Vector) -> Vector {
        along(self.origin, 1.0, self.turn(q))
    }

    /// The direction `q` of the shape in the scene.
    #[must_use]
    pub fn turn(&self, q: Vector) -> Vector {
        let [a, b, c] = self.axes;
        along(along(along([0.0; 3], q[0], a), q[1], b), q[2], c)
    }

    /// Own coordinates of a place of the scene.
    #[must_use]
    pub fn own(&self, x: Vector) -> Vector {
        let d = difference(x, self.origin);
        self.axes.map(|axis| dot(axis, d))
    }

    /// This frame within another one.
    #[must_use]
    pub fn within(&self, outer: &Self) -> Self {
        Self {
            origin: outer.place(self.origin),
            axes: self.axes.map(|axis| outer.turn(axis)),
        }
    }

    /// A frame at `origin` whose third axis is the given one of the scene, the others in rising order.
    #[must_use]
    pub fn upright(origin: Vector, axis: usize) -> Self {
        let unit = |k: usize| Self::SCENE.axes[k % 3];
        Self {
            origin,
            axes: [unit(axis + 1), unit(axis + 2), unit(axis)],
        }
    }

    /// A frame at `origin` whose third axis is `normal`; its first lies in the plane of a plane scene.
    #[must_use]
    pub fn facing(origin: Vector, normal: Vector) -> Self {
        let up = direction(normal);
        let least = (0..3).fold(0, |m, k| if up[k].abs() <= up[m].abs() { k } else { m });
        let first = direction(cross(Self::SCENE.axes[least], up));
        Self {
            origin,
            axes: [first, cross(up, first), up],
        }
    }

    /// The turn by `angle` \[rad\] about the given axis of the scene through `about`.
    #[must_use]
    pub fn turned(axis: usize, angle: f64, about: Vector) -> Self {
        let (sine, cosine) = angle.sin_cos();
        let mut axes = Self::SCENE.axes;
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        axes[a] = along(along([0.0; 3], cosine, axes[a]), sine, Self::SCENE.axes[b]);
        axes[b] = along(along([0.0; 3], cosine, axes[b]), -sine, Self::SCENE.axes[a]);
        let turn = Self {
            origin: [0.0; 3],
            axes,
        };
        Self {
            origin: difference(about, turn.turn(about)),
            axes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_keeps_its_axis_and_comes_back() {
        let about = [1.0, -2.0, 0.5];
        for axis in 0..3 {
            let turn = Frame::turned(axis, 0.7, about);
            let fixed = along(about, 3.0, Frame::SCENE.axes[axis]);
            assert!(length(difference(turn.place(fixed), fixed)) < 1e-14);
            let x = [0.3, 0.4, -0.9];
            assert!(length(difference(turn.own(turn.place(x)), x)) < 1e-14);
            let back = Frame::turned(axis, -0.7, about);
            assert!(length(difference(back.place(turn.place(x)), x)) < 1e-14);
        }
    }

    #[test]
    fn a_facing_frame_is_right_handed() {
        for normal in [[0.0, 0.0, 2.0], [1.0, -2.0, 0.3], [-1.0, 0.0, 0.0]] {
            let [a, b, c] = Frame::facing([0.0; 3], normal).axes;
            assert!(length(difference(cross(a, b), c)) < 1e-14);
            assert!((dot(c, normal) - length(normal)).abs() < 1e-14);
        }
    }
}
