//! What a frame tells of the heat that each particle of metal has got since the start.

use artefact::Frame;

/// Beginnings of the names of such columns.
const WAYS: [&str; 2] = ["heat_from_", "heat_lost"];

/// Names of the ways of heat that a frame tells, in its order.
#[must_use]
pub fn ways(frame: &Frame) -> Vec<String> {
    let names = frame.columns().iter().map(|column| &column.name);
    let told = names.filter(|name| WAYS.iter().any(|way| name.starts_with(way)));
    told.cloned().collect()
}

/// Heat that the particles of a frame have got, way by way.
#[derive(Debug, Clone, Default)]
pub struct Received {
    /// x and y in the frame of reference of the averages \[m\], `[n][2]`.
    pub place: Vec<[f64; 2]>,
    /// x of the plane beyond which each has an image that gets the same, in the same frame of reference \[m\].
    pub mirror: Option<f64>,
    /// Numbers for life, `[n]`.
    pub id: Vec<u32>,
    /// Whether it has come from the wire, `[n]`.
    pub droplet: Vec<bool>,
    /// Heat since the start \[J\], `[ways][n]`.
    pub heat: Vec<Vec<f64>>,
}

impl Received {
    /// Of `frame`, by `ways`, with the source at `origin` \[m\] and images beyond `mirror` \[m\].
    ///
    /// # Errors
    /// When a column is absent.
    pub fn read(
        frame: &Frame,
        ways: &[String],
        origin: [f64; 2],
        mirror: Option<f64>,
    ) -> artefact::Result<Self> {
        let place = frame.position_vectors()?.into_iter();
        let heat: artefact::Result<_> = ways.iter().map(|way| frame.f64(way)).collect();
        let id = frame.u32("id")?.to_vec();
        Ok(Self {
            place: place
                .map(|x| [x[0] - origin[0], x[1] - origin[1]])
                .collect(),
            mirror: mirror.map(|x| x - origin[0]),
            droplet: if frame.has("droplet") {
                frame.u8("droplet")?.iter().map(|mark| *mark != 0).collect()
            } else {
                vec![false; id.len()]
            },
            id,
            heat: heat?,
        })
    }

    /// Where particle `n` is, and its image, if it has one.
    pub fn places(&self, n: usize) -> impl Iterator<Item = [f64; 2]> {
        let [x, y] = self.place[n];
        let image = self.mirror.map(|at| [2.0 * at - x, y]);
        std::iter::once([x, y]).chain(image)
    }
}
