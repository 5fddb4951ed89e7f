//! A frame: named columns of equal length over particles or points at one instant.

use std::collections::BTreeMap;

use prost::Message;

use crate::cloud::{PackedElementField, PointCloud, identity_pose, timestamp};
use crate::error::{Error, Result};
use crate::values::{Precision, Values};

/// A named column with its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name; components of a vector end in `_x`, `_y`, `_z`.
    pub name: String,
    /// SI unit; `1` for a pure number.
    pub unit: String,
    /// One value per particle.
    pub values: Values,
}

/// Named columns of equal length. The position (`x`, `y`, `z`) comes first, so that Foxglove and
/// Lichtblick show the frame as a point cloud.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frame {
    /// Simulated time \[s\]; set by the reader.
    pub time_s: f64,
    precision: Precision,
    columns: Vec<Column>,
    origin: String,
}

impl Frame {
    /// A frame without columns whose floats have the given precision.
    #[must_use]
    pub fn new(precision: Precision) -> Self {
        Self {
            precision,
            ..Self::default()
        }
    }

    /// Adds `x`, `y`, `z` in metres.
    #[must_use]
    pub fn positions(self, positions: impl IntoIterator<Item = [f64; 3]>) -> Self {
        self.components(["x", "y", "z"], "m", positions)
    }

    /// Adds a vector as `name_x`, `name_y`, `name_z`.
    #[must_use]
    pub fn vector(
        self,
        name: &str,
        unit: &str,
        values: impl IntoIterator<Item = [f64; 3]>,
    ) -> Self {
        let names = ["x", "y", "z"].map(|axis| format!("{name}_{axis}"));
        self.components([&names[0], &names[1], &names[2]], unit, values)
    }

    fn components(
        mut self,
        names: [&str; 3],
        unit: &str,
        values: impl IntoIterator<Item = [f64; 3]>,
    ) -> Self {
        let mut split = [Vec::new(), Vec::new(), Vec::new()];
        for value in values {
            for (column, x) in split.iter_mut().zip(value) {
                column.push(x);
            }
        }
        for (name, column) in names.into_iter().zip(split) {
            self = self.scalar(name, unit, column);
        }
        self
    }

    /// Adds a scalar in the frame's precision.
    #[must_use]
    pub fn scalar(self, name: &str, unit: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let values = match self.precision {
            #[allow(
                clippy::cast_possible_truncation,
                reason = "the column is f32 on purpose"
            )]
            Precision::F32 => Values::F32(values.into_iter().map(|x| x as f32).collect()),
            Precision::F64 => Values::F64(values.into_iter().collect()),
        };
        self.column(name, unit, values)
    }

    /// Adds a column of flags (0 or 1) or small numbers.
    #[must_use]
    pub fn flag(self, name: &str, values: impl IntoIterator<Item = u8>) -> Self {
        self.column(name, "1", Values::U8(values.into_iter().collect()))
    }

    /// Adds a column of identifiers.
    #[must_use]
    pub fn id(self, name: &str, values: impl IntoIterator<Item = u32>) -> Self {
        self.column(name, "1", Values::U32(values.into_iter().collect()))
    }

    /// Adds a column.
    #[must_use]
    pub fn column(mut self, name: &str, unit: &str, values: Values) -> Self {
        self.columns.push(Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
        });
        self
    }

    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }

    /// Whether there is no particle.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes of a row, as they lie in the file before they are compressed.
    #[must_use]
    pub fn row_bytes(&self) -> usize {
        self.columns.iter().map(|c| c.values.width()).sum()
    }

    /// All columns in file order.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Whether a column exists: whether the physics that fills it was active.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|c| c.name == name)
    }

    /// A column by name.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent.
    pub fn get(&self, name: &str) -> Result<&Column> {
        self.columns
            .iter()
            .find(|c| c.name == name)
            .ok_or_else(|| Error::NoColumn {
                origin: self.origin.clone(),
                column: name.to_owned(),
                present: self
                    .columns
                    .iter()
                    .map(|c| c.name.as_str())
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    /// A column as `f64`.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent.
    pub fn f64(&self, name: &str) -> Result<Vec<f64>> {
        Ok(self.get(name)?.values.to_f64())
    }

    /// A column of flags.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent, [`Error::Unfit`] when it is no `u8` column.
    pub fn u8(&self, name: &str) -> Result<&[u8]> {
        match &self.get(name)?.values {
            Values::U8(v) => Ok(v),
            other => Err(self.unfit(name, "u8", other)),
        }
    }

    /// A column of identifiers.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent, [`Error::Unfit`] when it is no `u32` column.
    pub fn u32(&self, name: &str) -> Result<&[u32]> {
        match &self.get(name)?.values {
            Values::U32(v) => Ok(v),
            other => Err(self.unfit(name, "u32", other)),
        }
    }

    /// The positions \[m\].
    ///
    /// # Errors
    /// [`Error::NoColumn`] when there are none.
    pub fn position_vectors(&self) -> Result<Vec<[f64; 3]>> {
        self.join(["x", "y", "z"])
    }

    /// A vector column.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when a component is absent.
    pub fn vectors(&self, name: &str) -> Result<Vec<[f64; 3]>> {
        let names = ["x", "y", "z"].map(|axis| format!("{name}_{axis}"));
        self.join([&names[0], &names[1], &names[2]])
    }

    fn join(&self, names: [&str; 3]) -> Result<Vec<[f64; 3]>> {
        let [x, y, z] = [
            self.f64(names[0])?,
            self.f64(names[1])?,
            self.f64(names[2])?,
        ];
        Ok(x.into_iter()
            .zip(y)
            .zip(z)
            .map(|((x, y), z)| [x, y, z])
            .collect())
    }

    fn unfit(&self, name: &str, wanted: &str, found: &Values) -> Error {
        Error::Unfit {
            path: self.origin.clone().into(),
            channel: String::new(),
            what: format!(
                "column '{name}' is {}, wanted is {wanted}",
                found.type_name()
            ),
        }
    }

    /// What is wrong with the frame before it is written: unequal lengths, a name twice.
    pub(crate) fn fault(&self) -> Option<String> {
        let n = self.len();
        for (i, column) in self.columns.iter().enumerate() {
            if column.values.len() != n {
                let (name, found) = (&column.name, column.values.len());
                return Some(format!(
                    "column '{name}' has {found} entries, '{}' has {n}",
                    self.columns[0].name
                ));
            }
            if self.columns[..i].iter().any(|c| c.name == column.name) {
                return Some(format!("column '{}' stands twice", column.name));
            }
        }
        None
    }

    /// First value that is not finite: column, entry, value.
    pub(crate) fn not_finite(&self) -> Option<(String, usize, f64)> {
        self.columns
            .iter()
            .find_map(|c| c.values.not_finite().map(|(i, x)| (c.name.clone(), i, x)))
    }

    /// Unit and type of each column, in order: equal for all frames of a channel.
    pub(crate) fn layout(&self) -> Vec<(String, String, &'static str)> {
        self.columns
            .iter()
            .map(|c| (c.name.clone(), c.unit.clone(), c.values.type_name()))
            .collect()
    }

    /// The frame as a serialised `foxglove.PointCloud`.
    pub(crate) fn encode(&self, time_ns: u64) -> Vec<u8> {
        let stride: usize = self.columns.iter().map(|c| c.values.width()).sum();
        let mut data = vec![0; stride * self.len()];
        let mut fields = Vec::with_capacity(self.columns.len());
        let mut offset = 0;
        for column in &self.columns {
            column.values.pack(&mut data, offset, stride.max(1));
            fields.push(PackedElementField {
                name: column.name.clone(),
                offset: u32::try_from(offset).unwrap_or(u32::MAX),
                r#type: column.values.numeric(),
            });
            offset += column.values.width();
        }
        let cloud = PointCloud {
            timestamp: Some(timestamp(time_ns)),
            frame_id: "world".to_owned(),
            pose: Some(identity_pose()),
            point_stride: u32::try_from(stride).unwrap_or(u32::MAX),
            fields,
            data,
        };
        cloud.encode_to_vec()
    }

    /// A frame from a serialised `foxglove.PointCloud`.
    pub(crate) fn decode(
        bytes: &[u8],
        time_s: f64,
        units: &BTreeMap<String, String>,
        origin: String,
    ) -> std::result::Result<Self, String> {
        let cloud = PointCloud::decode(bytes).map_err(|e| format!("not a point cloud: {e}"))?;
        let stride = cloud.point_stride as usize;
        if stride == 0 || cloud.data.len() % stride != 0 {
            return Err(format!(
                "{} bytes of points are no multiple of the stride {stride}",
                cloud.data.len()
            ));
        }
        let mut columns = Vec::with_capacity(cloud.fields.len());
        for field in cloud.fields {
            let values = Values::unpack(field.r#type, &cloud.data, field.offset as usize, stride)
                .ok_or_else(|| {
                format!(
                    "field '{}' has an unknown type or leaves the stride",
                    field.name
                )
            })?;
            let unit = units.get(&field.name).cloned().unwrap_or_default();
            columns.push(Column {
                name: field.name,
                unit,
                values,
            });
        }
        Ok(Self {
            time_s,
            precision: Precision::F64,
            columns,
            origin,
        })
    }
}
