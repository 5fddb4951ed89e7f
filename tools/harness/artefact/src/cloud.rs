//! Foxglove's `PointCloud` message, written from its public `.proto` files, and its descriptor.
//!
//! The messages are `foxglove.PointCloud`, `foxglove.PackedElementField`, `foxglove.Pose`,
//! `foxglove.Vector3` and `foxglove.Quaternion`; field numbers and types are theirs.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{FileDescriptorProto, Timestamp};

use crate::descriptor::{encoded, field, file, message};

/// Name of the schema.
pub(crate) const SCHEMA: &str = "foxglove.PointCloud";

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Vector3 {
    #[prost(double, tag = "1")]
    pub(crate) x: f64,
    #[prost(double, tag = "2")]
    pub(crate) y: f64,
    #[prost(double, tag = "3")]
    pub(crate) z: f64,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Quaternion {
    #[prost(double, tag = "1")]
    pub(crate) x: f64,
    #[prost(double, tag = "2")]
    pub(crate) y: f64,
    #[prost(double, tag = "3")]
    pub(crate) z: f64,
    #[prost(double, tag = "4")]
    pub(crate) w: f64,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Pose {
    #[prost(message, optional, tag = "1")]
    pub(crate) position: Option<Vector3>,
    #[prost(message, optional, tag = "2")]
    pub(crate) orientation: Option<Quaternion>,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct PackedElementField {
    #[prost(string, tag = "1")]
    pub(crate) name: String,
    #[prost(fixed32, tag = "2")]
    pub(crate) offset: u32,
    #[prost(int32, tag = "3")]
    pub(crate) r#type: i32,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct PointCloud {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(crate) frame_id: String,
    #[prost(message, optional, tag = "3")]
    pub(crate) pose: Option<Pose>,
    #[prost(fixed32, tag = "4")]
    pub(crate) point_stride: u32,
    #[prost(message, repeated, tag = "5")]
    pub(crate) fields: Vec<PackedElementField>,
    #[prost(bytes = "vec", tag = "6")]
    pub(crate) data: Vec<u8>,
}

/// Numbers of Foxglove's `NumericType`.
pub(crate) mod numeric {
    pub(crate) const UINT8: i32 = 1;
    pub(crate) const UINT32: i32 = 5;
    pub(crate) const FLOAT32: i32 = 7;
    pub(crate) const FLOAT64: i32 = 8;
}

/// The pose of a frame that stands in the world: no shift, no turn.
pub(crate) fn identity_pose() -> Pose {
    Pose {
        position: Some(Vector3 {
            x: 0.0,
            y: 0.0,
            z: 0.0,
        }),
        orientation: Some(Quaternion {
            x: 0.0,
            y: 0.0,
            z: 0.0,
            w: 1.0,
        }),
    }
}

/// Simulated time as a timestamp.
pub(crate) fn timestamp(time_ns: u64) -> Timestamp {
    let (seconds, nanos) = (time_ns / 1_000_000_000, time_ns % 1_000_000_000);
    Timestamp {
        seconds: i64::try_from(seconds).unwrap_or(i64::MAX),
        nanos: i32::try_from(nanos).unwrap_or(0),
    }
}

/// The serialised `FileDescriptorSet` that describes [`PointCloud`] with all that it refers to.
pub(crate) fn descriptor() -> Vec<u8> {
    encoded(vec![cloud_file()])
}

fn cloud_file() -> FileDescriptorProto {
    let mut fields = vec![
        field(
            "timestamp",
            1,
            Type::Message,
            Some(".google.protobuf.Timestamp"),
        ),
        field("frame_id", 2, Type::String, None),
        field("pose", 3, Type::Message, Some(".foxglove.Pose")),
        field("point_stride", 4, Type::Fixed32, None),
        field(
            "fields",
            5,
            Type::Message,
            Some(".foxglove.PackedElementField"),
        ),
        field("data", 6, Type::Bytes, None),
    ];
    fields[4].label = Some(Label::Repeated.into());
    let needs = [
        "foxglove/PackedElementField.proto",
        "foxglove/Pose.proto",
        "google/protobuf/timestamp.proto",
    ];
    file("PointCloud", &needs, message("PointCloud", fields))
}
