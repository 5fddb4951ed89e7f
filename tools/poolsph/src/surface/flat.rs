//! The neighbours that a surface in a lid is measured by: the flow has images beyond the lid, and the surface has none.

use neighbours::{Grid, Lists};

use super::Cloud;
use crate::faces::{Faces, Images};
use crate::near::Near;

/// The moving particles and what is around them, without images beyond lids.
#[derive(Debug, Default)]
pub(super) struct Flat {
    /// The faces without lids, once they are known, and the cells of the search.
    kept: Option<(Faces, Grid)>,
    places: Vec<[f64; 3]>,
    images: Images,
    lists: Lists,
}

impl Flat {
    /// Finds the neighbours within `support` \[m\]; false, and nothing, where `faces` have no lid.
    pub(super) fn gather(&mut self, faces: &Faces, near: &Near, support: f64) -> bool {
        if self.kept.is_none() {
            let open = faces.without_lids();
            self.kept = open.map(|open| (open, Grid::new(support)));
        }
        let Some((open, grid)) = &mut self.kept else {
            return false;
        };
        self.places.clear();
        self.places.extend_from_slice(&near.position[..near.len()]);
        self.images.place(open, support, &mut self.places);
        grid.bin(&self.places);
        let points = &self.places[..near.len()];
        self.lists
            .build(grid.search(points, support), |_| true, |_, _| true);
        true
    }

    /// What was found.
    pub(super) fn cloud(&self) -> Cloud<'_> {
        Cloud {
            places: &self.places,
            images: &self.images,
            lists: &self.lists,
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        24 * self.places.capacity() + self.lists.bytes()
    }
}
