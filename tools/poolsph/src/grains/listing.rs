//! Lists of who may touch whom, made anew as grains stray.

use super::Motion;
use super::lists::Lists;
use super::sleep::Sleep;
use super::wall_list::Places;

impl Motion {
    /// Lists afresh who may touch metal.
    pub(super) fn list_metal(&mut self) {
        if let Some(metal) = &mut self.metal {
            metal.list(&self.moving.grains);
        }
    }

    /// Lists neighbours afresh; contacts that touch go along.
    pub(super) fn list(&mut self) {
        let (grains, listed) = (&self.moving.grains, &mut self.moving.listed);
        self.lists.mark_again(grains, listed, self.setting.radii);
        self.lists.memories(&mut self.memories[0], false);
        self.walls.memories(&mut self.memories[1]);
        self.list_with_memories();
    }

    /// Takes down what the contacts that touch remember, to list all of them again.
    pub(super) fn remember(&mut self) {
        self.lists.again.all();
        self.lists.memories(&mut self.memories[0], true);
        self.walls.memories(&mut self.memories[1]);
    }

    pub(super) fn list_with_memories(&mut self) {
        self.listings += 1.0;
        let (grains, radii) = (&self.moving.grains, self.setting.radii);
        let [between, at_walls] = &self.memories;
        let listed = &mut self.moving.listed;
        if self.lists.again.is_all() {
            listed.clear();
            listed.extend(grains.iter().map(|g| g.position));
        }
        self.lists.list(grains, listed, radii, between);
        let skin = Lists::skin(radii[0]);
        let places = Places {
            listed,
            still: &self.lists.again.still,
            skin,
        };
        self.walls.list(grains, places, at_walls);
        if let Some(sleep) = &mut self.sleep {
            sleep.list(&self.lists, grains.len());
        }
        let depth = self.sleep.as_ref().map_or(&[][..], Sleep::depth);
        self.lists.rest(depth);
        self.walls.rest(depth);
    }

    /// Whether someone may touch who is not listed, where grains have gone as far as `far` \[m\].
    pub(super) fn strayed(&self, far: f64) -> bool {
        let skin = Lists::skin(self.setting.radii[0]);
        // What is no number has strayed.
        let near = far + far.max(self.walls.strayed()) <= skin;
        !near
    }
}
