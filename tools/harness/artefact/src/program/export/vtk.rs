//! VTK's XML files, as ParaView reads them: raw appended data, little endian, 64-bit lengths.

use std::fmt::Write;

use artefact::{Column, Values, even_step};

use super::fields::{Field, fields};
use crate::program::sheet::Sheet;

/// A file on its way: the XML before the data, and the data.
struct File {
    head: String,
    data: Vec<u8>,
}

/// A frame as an unstructured grid of vertices.
pub(super) fn cloud(sheet: &Sheet) -> Vec<u8> {
    let n = sheet.rows();
    let mut file = File::new("UnstructuredGrid", "", sheet.time_s);
    let _ = writeln!(
        file.head,
        "    <Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{n}\">\n      <PointData>"
    );
    let place = |name: &str| sheet.columns.iter().find(|c| c.name == name);
    let is_place = |c: &Column| matches!(c.name.as_str(), "x" | "y" | "z");
    let columns: Vec<&Column> = sheet.columns.iter().filter(|c| !is_place(c)).collect();
    for field in fields(&columns) {
        file.field(&field);
    }
    let _ = writeln!(file.head, "      </PointData>\n      <Points>");
    let nowhere = Values::F64(vec![0.0; n]);
    let parts: Vec<&Values> = ["x", "y", "z"]
        .map(|name| place(name).map_or(&nowhere, |c| &c.values))
        .to_vec();
    let alike = parts.iter().all(|p| p.type_name() == parts[0].type_name());
    let wide: Vec<Values> = parts.iter().map(|p| Values::F64(p.to_f64())).collect();
    file.field(&Field {
        name: "position".to_owned(),
        unit: "m",
        parts: if alike { parts } else { wide.iter().collect() },
    });
    let _ = writeln!(file.head, "      </Points>\n      <Cells>");
    file.integers("connectivity", (0..n).map(|i| i as u64));
    file.integers("offsets", (1..=n).map(|i| i as u64));
    // VTK_VERTEX is cell type 1.
    file.field(&Field {
        name: "types".to_owned(),
        unit: "",
        parts: vec![&Values::U8(vec![1; n])],
    });
    let _ = writeln!(file.head, "      </Cells>\n    </Piece>");
    file.finish("UnstructuredGrid")
}

/// A grid as image data where its axes are even, else as a rectilinear grid; and the suffix.
///
/// An axis goes along x, y or z by its name (`y_m`; `radius_m` along x; `height_m` and `depth_m`
/// along z, a depth downwards), so that sections lie where the particles are; other axes take what is left. Along its
/// normal a section stands at the attribute `x_m`, `y_m` or `z_m`.
pub(super) fn grid(sheet: &Sheet) -> (Vec<u8>, &'static str) {
    let directions = directions(&sheet.axes);
    let mut along = [const { Vec::new() }; 3];
    for (axis, &direction) in sheet.axes.iter().zip(&directions) {
        along[direction] = axis.values.to_f64();
        if is_depth(axis) {
            along[direction] = along[direction].iter().rev().map(|depth| -depth).collect();
        }
    }
    for (axis, name) in along.iter_mut().zip(["x_m", "y_m", "z_m"]) {
        if axis.is_empty() {
            let place = sheet.attributes.iter().find(|a| a.name == name);
            axis.push(place.map_or(0.0, |a| a.values.to_f64()[0]));
        }
    }
    let last = along.each_ref().map(|axis| axis.len() - 1);
    let extent = format!("0 {} 0 {} 0 {}", last[0], last[1], last[2]);
    let spacing = along.each_ref().map(|axis| even(axis));
    let (kind, suffix, place) = match spacing {
        [Some(dx), Some(dy), Some(dz)] => {
            let [x, y, z] = along.each_ref().map(|axis| axis[0]);
            let place = format!(" Origin=\"{x} {y} {z}\" Spacing=\"{dx} {dy} {dz}\"");
            ("ImageData", "vti", place)
        }
        _ => ("RectilinearGrid", "vtr", String::new()),
    };
    let attributes = format!(" WholeExtent=\"{extent}\"{place}");
    let mut file = File::new(kind, &attributes, sheet.time_s);
    let _ = writeln!(
        file.head,
        "    <Piece Extent=\"{extent}\">\n      <PointData>"
    );
    let order = order(sheet, &directions, &along);
    let columns: Vec<Column> = sheet.columns.iter().map(|c| reorder(c, &order)).collect();
    for field in fields(&columns.iter().collect::<Vec<_>>()) {
        file.field(&field);
    }
    let _ = writeln!(file.head, "      </PointData>");
    if kind == "RectilinearGrid" {
        let _ = writeln!(file.head, "      <Coordinates>");
        for (name, axis) in ["x", "y", "z"].into_iter().zip(along) {
            file.field(&Field {
                name: name.to_owned(),
                unit: "m",
                parts: vec![&Values::F64(axis)],
            });
        }
        let _ = writeln!(file.head, "      </Coordinates>");
    }
    let _ = writeln!(file.head, "    </Piece>");
    (file.finish(kind), suffix)
}

/// The series of files of a channel over simulated time \[s\].
pub(super) fn collection(steps: &[(f64, String)]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n",
    );
    for (time, file) in steps.iter().filter(|(_, file)| !file.ends_with(".csv")) {
        let _ = writeln!(
            text,
            "    <DataSet timestep=\"{time}\" part=\"0\" file=\"{}\"/>",
            escaped(file)
        );
    }
    text + "  </Collection>\n</VTKFile>\n"
}

/// Whether all axes of a grid are lengths.
pub(super) fn is_place(sheet: &Sheet) -> bool {
    sheet.axes.iter().all(|axis| axis.unit == "m")
}

/// Whether an axis counts downwards from a surface.
fn is_depth(axis: &Column) -> bool {
    axis.name.split('_').next() == Some("depth")
}

/// Direction of each axis: 0, 1, 2 for x, y, z, each at most once.
fn directions(axes: &[Column]) -> Vec<usize> {
    let meant = |name: &str| {
        let word = name.split('_').next().unwrap_or_default();
        match word {
            "x" | "radius" | "radial" => Some(0),
            "y" => Some(1),
            "z" | "height" | "depth" | "axial" => Some(2),
            _ => None,
        }
    };
    let mut found: Vec<Option<usize>> = Vec::new();
    for axis in axes {
        let direction = meant(&axis.name).filter(|d| !found.contains(&Some(*d)));
        found.push(direction);
    }
    for i in 0..found.len() {
        if found[i].is_none() {
            found[i] = (0..3).find(|d| !found.contains(&Some(*d)));
        }
    }
    found.into_iter().map(|d| d.unwrap_or(0)).collect()
}

/// Spacing of an axis if it is even; 1 for a single entry.
fn even(axis: &[f64]) -> Option<f64> {
    if axis.len() == 1 {
        return Some(1.0);
    }
    even_step(axis)
}

/// Our node (last axis fastest) of each of VTK's nodes (x fastest).
fn order(sheet: &Sheet, directions: &[usize], along: &[Vec<f64>; 3]) -> Vec<usize> {
    let (mut stride, mut last) = ([0; 3], [None; 3]);
    let mut step = 1;
    for ((&direction, &n), axis) in directions.iter().zip(&sheet.shape).zip(&sheet.axes).rev() {
        stride[direction] = step;
        last[direction] = is_depth(axis).then_some(n - 1);
        step *= n;
    }
    let [nx, ny, nz] = along.each_ref().map(Vec::len);
    let nodes = (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])));
    let ours = |k: usize, i: usize| last[k].map_or(i, |last| last - i);
    nodes
        .map(|at| (0..3).map(|k| ours(k, at[k]) * stride[k]).sum())
        .collect()
}

fn reorder(column: &Column, order: &[usize]) -> Column {
    let values = column.values.to_f64();
    Column {
        name: column.name.clone(),
        unit: column.unit.clone(),
        values: Values::F64(order.iter().map(|&i| values[i]).collect()),
    }
}

impl File {
    fn new(kind: &str, attributes: &str, time_s: f64) -> Self {
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <{kind}{attributes}>\n    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time_s}</DataArray>\n    </FieldData>\n"
        );
        Self {
            head,
            data: Vec::new(),
        }
    }

    /// An array of one or more components.
    fn field(&mut self, field: &Field<'_>) {
        let kind = match field.parts[0] {
            Values::F32(_) => "Float32",
            Values::F64(_) => "Float64",
            Values::U8(_) => "UInt8",
            Values::U32(_) => "UInt32",
        };
        let mut bytes = Vec::new();
        for i in 0..field.parts[0].len() {
            for part in &field.parts {
                match part {
                    Values::F32(v) => bytes.extend(v[i].to_le_bytes()),
                    Values::F64(v) => bytes.extend(v[i].to_le_bytes()),
                    Values::U8(v) => bytes.push(v[i]),
                    Values::U32(v) => bytes.extend(v[i].to_le_bytes()),
                }
            }
        }
        self.array(kind, &field.name, field.unit, field.parts.len());
        self.append(&bytes);
    }

    fn integers(&mut self, name: &str, values: impl Iterator<Item = u64>) {
        self.array("Int64", name, "", 1);
        let bytes: Vec<u8> = values.flat_map(u64::to_le_bytes).collect();
        self.append(&bytes);
    }

    fn array(&mut self, kind: &str, name: &str, unit: &str, components: usize) {
        let start = format!(
            "        <DataArray type=\"{kind}\" Name=\"{}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{}\"",
            escaped(name),
            self.data.len()
        );
        self.head.push_str(&start);
        if unit.is_empty() {
            self.head.push_str("/>\n");
        } else {
            let _ = writeln!(
                self.head,
                "><InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey></DataArray>",
                escaped(unit)
            );
        }
    }

    fn append(&mut self, bytes: &[u8]) {
        self.data.extend((bytes.len() as u64).to_le_bytes());
        self.data.extend(bytes);
    }

    fn finish(self, kind: &str) -> Vec<u8> {
        let mut bytes = self.head.into_bytes();
        bytes.extend(format!("  </{kind}>\n  <AppendedData encoding=\"raw\">\n_").bytes());
        bytes.extend(self.data);
        bytes.extend(b"\n  </AppendedData>\n</VTKFile>\n");
        bytes
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}
