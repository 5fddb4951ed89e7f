//! Descriptors of Foxglove's messages: what tells a foreign reader how to take them apart.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto,
    FileDescriptorProto, FileDescriptorSet,
};

/// A serialised `FileDescriptorSet` of `own` files after the files that all of them need.
pub(crate) fn encoded(own: Vec<FileDescriptorProto>) -> Vec<u8> {
    let mut file = vec![
        timestamp_file(),
        vector_file(),
        quaternion_file(),
        pose_file(),
        element_file(),
    ];
    file.extend(own);
    FileDescriptorSet { file }.encode_to_vec()
}

pub(crate) fn field(
    name: &str,
    number: i32,
    kind: Type,
    type_name: Option<&str>,
) -> FieldDescriptorProto {
    FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: Some(number),
        label: Some(Label::Optional.into()),
        r#type: Some(kind.into()),
        type_name: type_name.map(str::to_owned),
        json_name: Some(name.to_owned()),
        ..Default::default()
    }
}

pub(crate) fn file(name: &str, needs: &[&str], message: DescriptorProto) -> FileDescriptorProto {
    FileDescriptorProto {
        name: Some(format!("foxglove/{name}.proto")),
        package: Some("foxglove".to_owned()),
        dependency: needs.iter().map(|&n| n.to_owned()).collect(),
        message_type: vec![message],
        syntax: Some("proto3".to_owned()),
        ..Default::default()
    }
}

pub(crate) fn message(name: &str, fields: Vec<FieldDescriptorProto>) -> DescriptorProto {
    DescriptorProto {
        name: Some(name.to_owned()),
        field: fields,
        ..Default::default()
    }
}

fn timestamp_file() -> FileDescriptorProto {
    FileDescriptorProto {
        name: Some("google/protobuf/timestamp.proto".to_owned()),
        package: Some("google.protobuf".to_owned()),
        message_type: vec![message(
            "Timestamp",
            vec![
                field("seconds", 1, Type::Int64, None),
                field("nanos", 2, Type::Int32, None),
            ],
        )],
        syntax: Some("proto3".to_owned()),
        ..Default::default()
    }
}

fn vector_file() -> FileDescriptorProto {
    let fields = ["x", "y", "z"]
        .iter()
        .zip(1..)
        .map(|(n, i)| field(n, i, Type::Double, None))
        .collect();
    file("Vector3", &[], message("Vector3", fields))
}

fn quaternion_file() -> FileDescriptorProto {
    let fields = ["x", "y", "z", "w"]
        .iter()
        .zip(1..)
        .map(|(n, i)| field(n, i, Type::Double, None))
        .collect();
    file("Quaternion", &[], message("Quaternion", fields))
}

fn pose_file() -> FileDescriptorProto {
    let fields = vec![
        field("position", 1, Type::Message, Some(".foxglove.Vector3")),
        field(
            "orientation",
            2,
            Type::Message,
            Some(".foxglove.Quaternion"),
        ),
    ];
    file(
        "Pose",
        &["foxglove/Quaternion.proto", "foxglove/Vector3.proto"],
        message("Pose", fields),
    )
}

fn element_file() -> FileDescriptorProto {
    let names = [
        "UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32", "FLOAT64",
    ];
    let value = names
        .iter()
        .zip(0..)
        .map(|(&name, number)| EnumValueDescriptorProto {
            name: Some(name.to_owned()),
            number: Some(number),
            options: None,
        })
        .collect();
    let fields = vec![
        field("name", 1, Type::String, None),
        field("offset", 2, Type::Fixed32, None),
        field(
            "type",
            3,
            Type::Enum,
            Some(".foxglove.PackedElementField.NumericType"),
        ),
    ];
    let mut element = message("PackedElementField", fields);
    element.enum_type = vec![EnumDescriptorProto {
        name: Some("NumericType".to_owned()),
        value,
        ..Default::default()
    }];
    file("PackedElementField", &[], element)
}
