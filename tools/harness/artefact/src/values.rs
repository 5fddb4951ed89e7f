//! The values of a column, and how they lie among the bytes of a point cloud.

use crate::cloud::numeric;

/// Width of the floating-point columns of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// 4 bytes: the default.
    #[default]
    F32,
    /// 8 bytes: where a scene asks for it.
    F64,
}

/// The values of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// 4-byte floating point.
    F32(Vec<f32>),
    /// 8-byte floating point.
    F64(Vec<f64>),
    /// Flags and small numbers.
    U8(Vec<u8>),
    /// Identifiers.
    U32(Vec<u32>),
}

impl Values {
    /// Number of entries.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::F32(v) => v.len(),
            Self::F64(v) => v.len(),
            Self::U8(v) => v.len(),
            Self::U32(v) => v.len(),
        }
    }

    /// Whether there is no entry.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All entries as `f64` (exact for every type).
    #[must_use]
    pub fn to_f64(&self) -> Vec<f64> {
        match self {
            Self::F32(v) => v.iter().map(|&x| f64::from(x)).collect(),
            Self::F64(v) => v.clone(),
            Self::U8(v) => v.iter().map(|&x| f64::from(x)).collect(),
            Self::U32(v) => v.iter().map(|&x| f64::from(x)).collect(),
        }
    }

    /// Name of the type: `f32`, `f64`, `u8`, `u32`.
    #[must_use]
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::F32(_) => "f32",
            Self::F64(_) => "f64",
            Self::U8(_) => "u8",
            Self::U32(_) => "u32",
        }
    }

    /// First entry that is not a finite number.
    pub(crate) fn not_finite(&self) -> Option<(usize, f64)> {
        match self {
            Self::F32(v) => v
                .iter()
                .position(|x| !x.is_finite())
                .map(|i| (i, f64::from(v[i]))),
            Self::F64(v) => v.iter().position(|x| !x.is_finite()).map(|i| (i, v[i])),
            Self::U8(_) | Self::U32(_) => None,
        }
    }

    pub(crate) fn width(&self) -> usize {
        match self {
            Self::U8(_) => 1,
            Self::F32(_) | Self::U32(_) => 4,
            Self::F64(_) => 8,
        }
    }

    pub(crate) fn numeric(&self) -> i32 {
        match self {
            Self::U8(_) => numeric::UINT8,
            Self::U32(_) => numeric::UINT32,
            Self::F32(_) => numeric::FLOAT32,
            Self::F64(_) => numeric::FLOAT64,
        }
    }

    pub(crate) fn pack(&self, data: &mut [u8], offset: usize, stride: usize) {
        let points = data.chunks_exact_mut(stride);
        match self {
            Self::U8(v) => points.zip(v).for_each(|(p, x)| p[offset] = *x),
            Self::U32(v) => points
                .zip(v)
                .for_each(|(p, x)| p[offset..offset + 4].copy_from_slice(&x.to_le_bytes())),
            Self::F32(v) => points
                .zip(v)
                .for_each(|(p, x)| p[offset..offset + 4].copy_from_slice(&x.to_le_bytes())),
            Self::F64(v) => points
                .zip(v)
                .for_each(|(p, x)| p[offset..offset + 8].copy_from_slice(&x.to_le_bytes())),
        }
    }

    pub(crate) fn unpack(kind: i32, data: &[u8], offset: usize, stride: usize) -> Option<Self> {
        fn gather<const N: usize, T>(
            data: &[u8],
            offset: usize,
            stride: usize,
            from: fn([u8; N]) -> T,
        ) -> Option<Vec<T>> {
            if offset + N > stride {
                return None;
            }
            data.chunks_exact(stride)
                .map(|p| p[offset..offset + N].try_into().ok().map(from))
                .collect()
        }
        match kind {
            numeric::UINT8 => gather(data, offset, stride, |[b]: [u8; 1]| b).map(Self::U8),
            numeric::UINT32 => gather(data, offset, stride, u32::from_le_bytes).map(Self::U32),
            numeric::FLOAT32 => gather(data, offset, stride, f32::from_le_bytes).map(Self::F32),
            numeric::FLOAT64 => gather(data, offset, stride, f64::from_le_bytes).map(Self::F64),
            _ => None,
        }
    }
}
