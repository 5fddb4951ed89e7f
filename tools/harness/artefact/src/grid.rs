//! Foxglove's `Grid` message, written from its public `.proto` files, and how a table lies in it.

use prost::Message;
use prost_types::Timestamp;
use prost_types::field_descriptor_proto::{Label, Type};

use crate::cloud::{PackedElementField, Pose, timestamp};
use crate::descriptor::{encoded, field, file, message};
use crate::lattice::Lattice;
use crate::table::{Series, Table};
use crate::values::{Precision, Values};

/// Name of the schema.
pub(crate) const SCHEMA: &str = "foxglove.Grid";
/// The message may differ from the axes by this part of a cell.
const NEAR: f64 = 1e-6;

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Vector2 {
    #[prost(double, tag = "1")]
    pub(crate) x: f64,
    #[prost(double, tag = "2")]
    pub(crate) y: f64,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Grid {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(crate) frame_id: String,
    #[prost(message, optional, tag = "3")]
    pub(crate) pose: Option<Pose>,
    #[prost(fixed32, tag = "4")]
    pub(crate) column_count: u32,
    #[prost(message, optional, tag = "5")]
    pub(crate) cell_size: Option<Vector2>,
    #[prost(fixed32, tag = "6")]
    pub(crate) row_stride: u32,
    #[prost(fixed32, tag = "7")]
    pub(crate) cell_stride: u32,
    #[prost(message, repeated, tag = "8")]
    pub(crate) fields: Vec<PackedElementField>,
    #[prost(bytes = "vec", tag = "9")]
    pub(crate) data: Vec<u8>,
}

/// The serialised `FileDescriptorSet` that describes [`Grid`] with all that it refers to.
pub(crate) fn descriptor() -> Vec<u8> {
    let vector = ["x", "y"].iter().zip(1..);
    let vector = vector.map(|(name, i)| field(name, i, Type::Double, None));
    let plane = file("Vector2", &[], message("Vector2", vector.collect()));
    let part = |name, i, kind| field(name, i, Type::Message, Some(kind));
    let mut fields = vec![
        part("timestamp", 1, ".google.protobuf.Timestamp"),
        field("frame_id", 2, Type::String, None),
        part("pose", 3, ".foxglove.Pose"),
        field("column_count", 4, Type::Fixed32, None),
        part("cell_size", 5, ".foxglove.Vector2"),
        field("row_stride", 6, Type::Fixed32, None),
        field("cell_stride", 7, Type::Fixed32, None),
        part("fields", 8, ".foxglove.PackedElementField"),
        field("data", 9, Type::Bytes, None),
    ];
    fields[7].label = Some(Label::Repeated.into());
    let needs = [
        "foxglove/PackedElementField.proto",
        "foxglove/Pose.proto",
        "foxglove/Vector2.proto",
        "google/protobuf/timestamp.proto",
    ];
    let grid = file("Grid", &needs, message("Grid", fields));
    encoded(vec![plane, grid])
}

/// A table on `lattice` as a serialised `foxglove.Grid`; a value is a cell around its node.
pub(crate) fn encode(table: &Table, lattice: &Lattice, time_ns: u64) -> Vec<u8> {
    let narrow = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let columns: Vec<Values> = table.columns.iter().map(|c| packed(c, table)).collect();
    let stride: usize = columns.iter().map(Values::width).sum();
    let mut data = vec![0; stride * table.len()];
    let mut fields = Vec::with_capacity(columns.len());
    let mut offset = 0;
    for (column, values) in table.columns.iter().zip(&columns) {
        values.pack(&mut data, offset, stride);
        fields.push(PackedElementField {
            name: column.name.clone(),
            offset: narrow(offset),
            r#type: values.numeric(),
        });
        offset += values.width();
    }
    let grid = Grid {
        timestamp: Some(timestamp(time_ns)),
        frame_id: table.frame_id().to_owned(),
        pose: Some(lattice.pose()),
        column_count: narrow(lattice.shape[1]),
        cell_size: Some(Vector2 {
            x: lattice.cell[1],
            y: lattice.cell[0],
        }),
        row_stride: narrow(stride * lattice.shape[1]),
        cell_stride: narrow(stride),
        fields,
        data,
    };
    grid.encode_to_vec()
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "the column is f32 on purpose"
)]
fn packed(column: &Series, table: &Table) -> Values {
    match table.precision() {
        Precision::F32 => Values::F32(column.values.iter().map(|&x| x as f32).collect()),
        Precision::F64 => Values::F64(column.values.clone()),
    }
}

/// Adds the columns of a serialised `foxglove.Grid` to a table that has its axes and attributes.
/// `layout` names each column with its type, `unit` gives its unit.
pub(crate) fn decode(
    bytes: &[u8],
    mut table: Table,
    layout: &[String],
    unit: impl Fn(&str) -> String,
) -> Result<Table, String> {
    let grid = Grid::decode(bytes).map_err(|e| format!("not a grid: {e}"))?;
    let lattice = Lattice::of(&table)
        .ok_or_else(|| "its axes, as the channel gives them, are not those of a grid".to_owned())?;
    must_lie(&grid, &lattice)?;
    must_stand(&grid, &lattice, table.frame_id())?;
    let stride = grid.cell_stride as usize;
    let mut found = Vec::with_capacity(layout.len());
    for field in grid.fields {
        let values = Values::unpack(field.r#type, &grid.data, field.offset as usize, stride);
        let values = values.ok_or_else(|| {
            let name = &field.name;
            format!("field '{name}' has an unknown type or leaves the cell")
        })?;
        found.push(format!("{} {}", field.name, values.type_name()));
        table.columns.push(Series {
            unit: unit(&field.name),
            name: field.name,
            values: values.to_f64(),
        });
    }
    if found != layout {
        return Err(format!("columns {found:?}, the channel says {layout:?}"));
    }
    let narrow = !layout.is_empty() && layout.iter().all(|column| column.ends_with(" f32"));
    let precision = if narrow {
        Precision::F32
    } else {
        Precision::F64
    };
    Ok(table.in_precision(precision))
}

/// Refuses bytes that are not rows of cells without gaps, as many as the axes have nodes.
fn must_lie(grid: &Grid, lattice: &Lattice) -> Result<(), String> {
    let [rows, columns] = lattice.shape.map(|n| n as u64);
    let [found, row, cell] = [grid.column_count, grid.row_stride, grid.cell_stride].map(u64::from);
    if found != columns {
        return Err(format!(
            "{found} columns, the second axis has {columns} entries"
        ));
    }
    if row != columns * cell || (cell == 0 && !grid.fields.is_empty()) {
        return Err(format!(
            "a row of {row} bytes is not {columns} cells of {cell} bytes"
        ));
    }
    let bytes = grid.data.len() as u64;
    if bytes != rows * row {
        return Err(format!(
            "{bytes} bytes of cells are not {rows} rows of {row} bytes"
        ));
    }
    Ok(())
}

/// Refuses cells of another size or in another place than the axes say.
fn must_stand(grid: &Grid, lattice: &Lattice, frame: &str) -> Result<(), String> {
    if grid.frame_id != frame {
        let found = &grid.frame_id;
        return Err(format!("frame '{found}', the channel says '{frame}'"));
    }
    let size = grid.cell_size.clone().unwrap_or_default();
    let [y, x] = lattice.cell;
    let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= NEAR * scale;
    if !near(size.x, x, x) || !near(size.y, y, y) {
        return Err(format!(
            "cells of {} m by {} m, the axes have steps of {x} m and {y} m",
            size.x, size.y
        ));
    }
    let (found, expected) = (grid.pose.clone().unwrap_or_default(), lattice.pose());
    let (p, q) = (
        found.position.unwrap_or_default(),
        found.orientation.unwrap_or_default(),
    );
    let (a, b) = (
        expected.position.unwrap_or_default(),
        expected.orientation.unwrap_or_default(),
    );
    let there = [(p.x, a.x), (p.y, a.y), (p.z, a.z)]
        .into_iter()
        .all(|(p, a)| near(p, a, x.min(y)));
    let turned = [(q.x, b.x), (q.y, b.y), (q.z, b.z), (q.w, b.w)];
    if there && turned.into_iter().all(|(q, b)| near(q, b, 1.0)) {
        return Ok(());
    }
    Err(format!(
        "its corner is at ({}, {}, {}) m, the axes put it at ({}, {}, {}) m with another turn or none",
        p.x, p.y, p.z, a.x, a.y, a.z
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::numeric;

    fn bare() -> Table {
        Table::grid(&[("y_m", "m", &[0.0, 0.1, 0.2]), ("z_m", "m", &[-1.0, -0.5])])
            .attribute("x_m", "m", 0.25)
    }

    fn full() -> Table {
        bare()
            .column("speed_m_s", "m/s", (0..6).map(f64::from))
            .column(
                "share",
                "1",
                [0.1, -0.0, f64::MIN_POSITIVE, 1e300, 0.3, -7.5],
            )
    }

    fn bytes() -> Vec<u8> {
        encode(&full(), &Lattice::of(&full()).unwrap(), 1_500_000_000)
    }

    fn layout(kind: &str) -> [String; 2] {
        ["speed_m_s", "share"].map(|name| format!("{name} {kind}"))
    }

    fn unit(name: &str) -> String {
        if name == "share" { "1" } else { "m/s" }.to_owned()
    }

    #[test]
    fn a_table_comes_back_to_the_last_bit() {
        let back = decode(&bytes(), bare(), &layout("f64"), unit).unwrap();
        assert_eq!(back, full());
        assert!(back.columns[1].values[1].is_sign_negative());
        let grid = Grid::decode(bytes().as_slice()).unwrap();
        assert_eq!(
            (grid.column_count, grid.row_stride, grid.cell_stride),
            (2, 32, 16)
        );
        assert_eq!(grid.timestamp.unwrap().nanos, 500_000_000);
        let size = grid.cell_size.unwrap();
        assert!((size.x - 0.5).abs() < 1e-15 && (size.y - 0.1).abs() < 1e-15);
        let corner = grid.pose.unwrap().position.unwrap();
        for (found, exact) in [(corner.x, 0.25), (corner.y, -0.05), (corner.z, -1.25)] {
            assert!((found - exact).abs() < 1e-15, "{found} {exact}");
        }
    }

    #[test]
    fn narrow_columns_come_back_as_they_were_rounded() {
        let table = full().in_precision(Precision::F32);
        assert_eq!(table.not_finite().unwrap().1, 3, "1e300 is no f32");
        let table = bare().in_precision(Precision::F32).column(
            "share",
            "1",
            (0..6).map(|i| f64::from(i) / 7.0),
        );
        let lattice = Lattice::of(&table).unwrap();
        let once = encode(&table, &lattice, 0);
        let back = decode(&once, bare(), &layout("f32")[1..], unit).unwrap();
        assert_eq!(back.precision(), Precision::F32);
        assert_eq!(encode(&back, &lattice, 0), once);
        for (found, x) in back.columns[0].values.iter().zip(&table.columns[0].values) {
            assert_eq!(found.to_bits(), f64::from(*x as f32).to_bits());
        }
    }

    #[test]
    fn narrow_fields_and_values_that_are_no_numbers_are_read_as_they_stand() {
        let mut grid = Grid::decode(bytes().as_slice()).unwrap();
        let values = [1.5_f32, f32::NAN, -2.0, f32::INFINITY, 0.0, 4.0];
        grid.data = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        grid.fields = vec![PackedElementField {
            name: "speed_m_s".to_owned(),
            offset: 0,
            r#type: numeric::FLOAT32,
        }];
        (grid.cell_stride, grid.row_stride) = (4, 8);
        let back = decode(&grid.encode_to_vec(), bare(), &layout("f32")[..1], unit).unwrap();
        let found = back.values("speed_m_s").unwrap();
        assert!(found[1].is_nan() && found[3] == f64::INFINITY);
        for (row, exact) in [(0, 1.5_f64), (2, -2.0), (5, 4.0)] {
            assert_eq!(found[row].to_bits(), exact.to_bits());
        }
    }

    /// What is said of the message after `spoil` has been at it.
    fn said(spoil: impl FnOnce(&mut Grid)) -> String {
        let mut grid = Grid::decode(bytes().as_slice()).unwrap();
        spoil(&mut grid);
        decode(&grid.encode_to_vec(), bare(), &layout("f64"), unit).unwrap_err()
    }

    #[test]
    fn bytes_that_do_not_lie_as_they_should_are_refused_with_both_numbers() {
        assert_eq!(
            said(|g| g.column_count = 3),
            "3 columns, the second axis has 2 entries"
        );
        assert_eq!(
            said(|g| g.row_stride = 40),
            "a row of 40 bytes is not 2 cells of 16 bytes"
        );
        assert_eq!(
            said(|g| (g.cell_stride, g.row_stride) = (0, 0)),
            "a row of 0 bytes is not 2 cells of 0 bytes"
        );
        assert_eq!(
            said(|g| g.data.truncate(95)),
            "95 bytes of cells are not 3 rows of 32 bytes"
        );
        assert_eq!(
            said(|g| g.fields[1].offset = 9),
            "field 'share' has an unknown type or leaves the cell"
        );
        assert_eq!(
            said(|g| drop(g.fields.pop())),
            "columns [\"speed_m_s f64\"], the channel says [\"speed_m_s f64\", \"share f64\"]"
        );
        assert_eq!(
            said(|g| g.fields[0].r#type = 99),
            "field 'speed_m_s' has an unknown type or leaves the cell"
        );
    }

    #[test]
    fn cells_that_stand_elsewhere_are_refused() {
        let size = said(|g| g.cell_size.as_mut().unwrap().y = 0.2);
        assert!(
            size.starts_with("cells of 0.5 m by 0.2 m, the axes"),
            "{size}"
        );
        assert!(said(|g| g.cell_size = None).starts_with("cells of 0 m by 0 m"));
        let place = said(|g| g.pose.as_mut().unwrap().position.as_mut().unwrap().x = 0.0);
        assert!(place.starts_with("its corner is at (0, "), "{place}");
        let turn = said(|g| g.pose.as_mut().unwrap().orientation = None);
        assert!(turn.contains("another turn"), "{turn}");
        let frame = said(|g| g.frame_id = "map".to_owned());
        assert_eq!(frame, "frame 'map', the channel says 'world'");
    }

    #[test]
    fn a_message_that_breaks_off_is_refused() {
        let whole = bytes();
        for end in 0..whole.len() {
            assert!(
                decode(&whole[..end], bare(), &layout("f64"), unit).is_err(),
                "{end} bytes"
            );
        }
        let uneven = Table::grid(&[("y_m", "m", &[0.0, 0.1, 0.3]), ("z_m", "m", &[0.0, 1.0])]);
        let said = decode(&whole, uneven, &layout("f64"), unit).unwrap_err();
        assert!(said.contains("axes"), "{said}");
    }
}
