//! Nodes of a mesh in the words of Abaqus, which CalculiX shares.

/// A node: its number, and its place \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub(super) number: u64,
    pub(super) place: [f64; 3],
}

/// The nodes of all blocks `*NODE` of a file whose lengths are in `unit` \[m\].
///
/// # Errors
/// Says which line is none, and where there is no node.
pub(super) fn nodes(text: &str, unit: f64) -> Result<Vec<Node>, String> {
    let (mut nodes, mut inside) = (Vec::new(), false);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.starts_with("**") || line.is_empty() {
            continue;
        }
        if let Some(keyword) = line.strip_prefix('*') {
            let first = keyword.split(',').next().unwrap_or_default();
            inside = first.trim().eq_ignore_ascii_case("node");
            continue;
        }
        if inside {
            let node = node(line, unit);
            nodes.push(node.ok_or_else(|| {
                format!(
                    "line {}: wanted are a number and three coordinates: {line}",
                    number + 1
                )
            })?);
        }
    }
    match nodes.is_empty() {
        true => Err("has no block *NODE with nodes".to_owned()),
        false => Ok(nodes),
    }
}

fn node(line: &str, unit: f64) -> Option<Node> {
    let mut words = line.split(',').map(str::trim);
    let number = words.next()?.parse().ok()?;
    // Coordinates that are left out are 0.
    let mut coordinate = || match words.next() {
        None | Some("") => Some(0.0),
        Some(word) => word.parse::<f64>().ok().filter(|x| x.is_finite()),
    };
    let place = [coordinate()?, coordinate()?, coordinate()?];
    Some(Node {
        number,
        place: place.map(|x| unit * x),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_read_with_their_unit_and_nothing_else_is() {
        let text = "*HEADING\nA plate\n** a remark\n*NODE, NSET=ALL\n1, 0., 1.5, -2\n 7 ,3.0, 4e0,\n\
                    *ELEMENT, TYPE=C3D8\n1, 1, 7\n*node\n9, 1\n*NODE PRINT\nU\n";
        let found = nodes(text, 1e-3).unwrap();
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        assert_eq!(
            found.iter().map(|n| n.number).collect::<Vec<_>>(),
            [1, 7, 9]
        );
        assert!(near(found[0].place, [0.0, 1.5e-3, -2e-3]));
        assert!(near(found[1].place, [3e-3, 4e-3, 0.0]));
        assert!(near(found[2].place, [1e-3, 0.0, 0.0]));
    }

    #[test]
    fn what_is_no_node_is_told() {
        let told = nodes("*NODE\n1, 0, 0, 0\n2, x, 0, 0\n", 1.0).unwrap_err();
        assert!(told.contains("line 3"), "{told}");
        assert!(
            nodes("*ELEMENT\n1, 2\n", 1.0)
                .unwrap_err()
                .contains("*NODE")
        );
    }
}
