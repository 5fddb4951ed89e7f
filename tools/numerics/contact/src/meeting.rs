//! The geometry of one contact.

use shapes::frame::{Vector, along, cross, difference, dot, length, scaled};

/// A grain as a contact sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Place of its centre \[m\].
    pub position: Vector,
    /// Velocity of its centre \[m/s\].
    pub velocity: Vector,
    /// Angular velocity \[rad/s\].
    pub spin: Vector,
    /// Radius \[m\].
    pub radius: f64,
    /// Mass \[kg\].
    pub mass: f64,
}

/// Where and how two grains, or a grain and a wall, touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Unit normal of the contact, from b to a.
    pub normal: Vector,
    /// Overlap \[m\], above zero.
    pub overlap: f64,
    /// From the centres of a and b to the plane of contact \[m\]; zero for a wall.
    pub arms: [f64; 2],
    /// Speed at which the overlap grows \[m/s\].
    pub approach: f64,
    /// Velocity of a's surface past b's in the plane of contact \[m/s\].
    pub slide: Vector,
    /// Difference of the angular velocities of a and b \[rad/s\].
    pub turn: Vector,
    /// Angular velocity of the normal \[rad/s\]; that of a wall is taken to stay.
    pub swing: Vector,
    /// Effective mass 1 / (1/m_a + 1/m_b) \[kg\].
    pub mass: f64,
    /// Effective radius 1 / (1/r_a + 1/r_b) \[m\].
    pub radius: f64,
}

impl Meeting {
    /// The contact of two grains; `None` where they do not overlap, or where their centres coincide so that no normal is known.
    ///
    /// The plane of contact is that of the circle in which both spheres cut each other:
    /// `l_a = (d^2 + r_a^2 - r_b^2) / (2 d)` at the distance d of the centres.
    #[inline]
    #[must_use]
    pub fn of(a: &Grain, b: &Grain) -> Option<Self> {
        let apart = difference(a.position, b.position);
        let squared = dot(apart, apart);
        let reach = a.radius + b.radius;
        if squared >= reach * reach || squared <= f64::MIN_POSITIVE {
            return None;
        }
        Some(Self::at(a, b, apart, squared))
    }

    /// The contact of two grains that are known to overlap.
    #[inline(always)]
    #[must_use]
    pub fn overlapping(a: &Grain, b: &Grain) -> Self {
        let apart = difference(a.position, b.position);
        Self::at(a, b, apart, dot(apart, apart))
    }

    /// Two grains that have just parted: the overlap is what is between them, below zero.
    #[must_use]
    pub fn parted(a: &Grain, b: &Grain) -> Option<Self> {
        let apart = difference(a.position, b.position);
        let squared = dot(apart, apart);
        (squared > f64::MIN_POSITIVE).then(|| Self::at(a, b, apart, squared))
    }

    #[inline(always)]
    fn at(a: &Grain, b: &Grain, apart: Vector, squared: f64) -> Self {
        let reach = a.radius + b.radius;
        let distance = squared.sqrt();
        let inverse = 1.0 / distance;
        let normal = scaled(inverse, apart);
        let lens = (a.radius - b.radius) * reach * inverse;
        let arms = [0.5 * (distance + lens), 0.5 * (distance - lens)];
        // u_t = u - (u.n) n - (l_a w_a + l_b w_b) x n, n from b to a (eq. 3.113 with its sign made right).
        let past = difference(a.velocity, b.velocity);
        let opening = dot(past, normal);
        let rolled = along(scaled(arms[0], a.spin), arms[1], b.spin);
        // dn/dt = (u - (u.n) n) / d = swing x n
        let swing = scaled(inverse, cross(normal, past));
        Self {
            normal,
            overlap: reach - distance,
            arms,
            approach: -opening,
            slide: difference(along(past, -opening, normal), cross(rolled, normal)),
            turn: difference(a.spin, b.spin),
            swing,
            mass: a.mass * b.mass / (a.mass + b.mass),
            radius: a.radius * b.radius / reach,
        }
    }

    /// A contact that began within the last step of `step` \[s\], as the first force sees it, and the step that stretches its springs.
    ///
    /// A dashpot pushes at once when the contact begins, a part `q = overlap / (approach step)` of the step ago. The force
    /// at the end of the step acts over its second half and over the first half of the next, `q + 1/2` of them in all; the
    /// velocities are counted so much. Without that the restitution has an error of the first order that hangs on chance.
    #[must_use]
    pub fn begun(mut self, step: f64) -> (Self, f64) {
        let grown = self.approach * step;
        if self.overlap >= grown {
            return (self, step);
        }
        let part = self.overlap / grown;
        let counted = part + 0.5;
        self.approach *= counted;
        self.slide = self.slide.map(|u| counted * u);
        self.turn = self.turn.map(|w| counted * w);
        (self, step * part / counted)
    }

    /// A contact that ended within the last step of `step` \[s\] while its dashpot pulled, as a last force sees it: of the half step
    /// that the force before it acted too long or too short the rest is made good.
    #[must_use]
    pub fn ended(mut self, step: f64) -> Self {
        let parted = (-self.approach * step).max(f64::MIN_POSITIVE);
        let part = (1.0 + self.overlap / parted).clamp(0.0, 1.0);
        self.approach *= part - 0.5;
        self.overlap = 0.0;
        self.slide = [0.0; 3];
        self
    }

    /// The contact of a grain with a wall whose surface is `distance` \[m\] from its centre, `normal` out of the wall, moving
    /// with `velocity` \[m/s\]; `None` where they do not overlap.
    #[inline]
    #[must_use]
    pub fn at_wall(a: &Grain, distance: f64, normal: Vector, velocity: Vector) -> Option<Self> {
        (distance < a.radius).then(|| Self::beside_wall(a, distance, normal, velocity))
    }

    /// A grain beside a wall, whether it touches or not: the overlap may be below zero.
    #[inline]
    #[must_use]
    pub fn beside_wall(a: &Grain, distance: f64, normal: Vector, velocity: Vector) -> Self {
        let past = difference(a.velocity, velocity);
        let opening = dot(past, normal);
        let arm = distance.max(0.0);
        let rolled = scaled(arm, a.spin);
        Self {
            normal,
            overlap: a.radius - distance,
            arms: [arm, 0.0],
            approach: -opening,
            slide: difference(along(past, -opening, normal), cross(rolled, normal)),
            turn: a.spin,
            swing: [0.0; 3],
            mass: a.mass,
            radius: a.radius,
        }
    }

    /// A grain beside a mirror plane that is `distance` \[m\] from its centre: the contact with its own image, whether it touches or not.
    ///
    /// The image has the same speed along the plane and turns the other way about what lies in it, so that nothing slides.
    #[inline]
    #[must_use]
    pub fn with_image(a: &Grain, distance: f64, normal: Vector) -> Self {
        let along_normal = |v: Vector| dot(v, normal);
        let arm = distance.max(0.0);
        Self {
            normal,
            overlap: 2.0 * (a.radius - distance),
            arms: [arm, arm],
            approach: -2.0 * along_normal(a.velocity),
            slide: [0.0; 3],
            turn: scaled(2.0, along(a.spin, -along_normal(a.spin), normal)),
            swing: [0.0; 3],
            mass: 0.5 * a.mass,
            radius: 0.5 * a.radius,
        }
    }

    /// The contact of a grain with a body at rest or moving as a whole, by the body's signed distance (negative inside);
    /// a grain whose centre has passed the surface is pushed out along the same normal.
    #[must_use]
    pub fn at_body(a: &Grain, body: &shapes::Body, velocity: Vector) -> Option<Self> {
        let distance = body.distance(a.position);
        if distance >= a.radius {
            return None;
        }
        let normal = body.normal(a.position, 1e-6 * a.radius);
        (length(normal) > 0.5)
            .then(|| Self::at_wall(a, distance, normal, velocity))
            .flatten()
    }
}
