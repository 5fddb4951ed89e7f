//! NumPy archives: one array per column, under its name.

use std::io::{self, Cursor, Write};

use artefact::{Column, Values};
use npyz::WriterBuilder;
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, ZipWriter};

use super::series::Series;
use crate::program::sheet::Sheet;

/// A frame, table or grid with its axes, the scalars that belong to it, and `log_time_s`.
pub(super) fn sheet(sheet: &Sheet) -> io::Result<Vec<u8>> {
    let mut archive = Archive::new();
    let shape: Vec<u64> = sheet.shape.iter().map(|&n| n as u64).collect();
    for axis in &sheet.axes {
        archive.column(axis, &[axis.values.len() as u64])?;
    }
    for column in &sheet.columns {
        archive.column(column, &shape)?;
    }
    for attribute in &sheet.attributes {
        archive.column(attribute, &[])?;
    }
    archive.array("log_time_s", &Values::F64(vec![sheet.time_s]), &[])?;
    archive.finish()
}

/// Scalars over time; NaN where a message does not have one.
pub(super) fn series(series: &Series) -> io::Result<Vec<u8>> {
    let mut archive = Archive::new();
    let times = series.times();
    let rows = times.len() as u64;
    archive.array("log_time_s", &Values::F64(times), &[rows])?;
    for (name, _) in &series.columns {
        let values = series.column(name).into_iter();
        let values = values.map(|x| x.unwrap_or(f64::NAN)).collect();
        archive.array(name, &Values::F64(values), &[rows])?;
    }
    archive.finish()
}

struct Archive {
    zip: ZipWriter<Cursor<Vec<u8>>>,
}

impl Archive {
    fn new() -> Self {
        Self {
            zip: ZipWriter::new(Cursor::new(Vec::new())),
        }
    }

    fn column(&mut self, column: &Column, shape: &[u64]) -> io::Result<()> {
        self.array(&column.name, &column.values, shape)
    }

    fn array(&mut self, name: &str, values: &Values, shape: &[u64]) -> io::Result<()> {
        let bytes = match values {
            Values::F32(v) => encode(v, shape),
            Values::F64(v) => encode(v, shape),
            Values::U8(v) => encode(v, shape),
            Values::U32(v) => encode(v, shape),
        }?;
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(bytes.len() > u32::MAX as usize);
        let name = npyz::npz::file_name_from_array_name(name);
        self.zip
            .start_file(name, options)
            .map_err(io::Error::other)?;
        self.zip.write_all(&bytes)
    }

    fn finish(self) -> io::Result<Vec<u8>> {
        let cursor = self.zip.finish().map_err(io::Error::other)?;
        Ok(cursor.into_inner())
    }
}

fn encode<T: npyz::AutoSerialize + Copy>(values: &[T], shape: &[u64]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut writer = npyz::WriteOptions::<T>::new()
        .default_dtype()
        .shape(shape)
        .writer(&mut bytes)
        .begin_nd()?;
    writer.extend(values.iter().copied())?;
    writer.finish()?;
    Ok(bytes)
}
