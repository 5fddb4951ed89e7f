//! A column as a set holds it, and several of them at once.

use crate::column::Column;
use crate::store::{Store, Value};

/// A column that is held.
#[derive(Debug, Clone)]
pub struct Held {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) saved: bool,
    pub(crate) shown: bool,
    /// One value: that of a new particle.
    pub(crate) default: Store,
    pub(crate) values: Store,
}

/// Columns that are changed side by side.
pub trait Several {
    /// Their values.
    type Values<'s>;

    /// The values among those that are held.
    fn of(self, held: &mut [Held]) -> Self::Values<'_>;
}

/// Makes a tuple of columns one of [`Several`].
macro_rules! several {
    ($($column:ident $values:ident $type:ident),+) => {
        impl<$($type: Value),+> Several for ($(&Column<$type>,)+) {
            type Values<'s> = ($(&'s mut [$type],)+);

            fn of(self, held: &mut [Held]) -> Self::Values<'_> {
                let ($($column,)+) = self;
                $(let mut $values: &mut [$type] = &mut [];)+
                for held in held {
                    $(if held.name == $column.name {
                        $values = $type::of_mut(&mut held.values).map_or(&mut [], Vec::as_mut_slice);
                        continue;
                    })+
                }
                ($($values,)+)
            }
        }
    };
}

several!(a a_values A, b b_values B);
several!(a a_values A, b b_values B, c c_values C);
several!(a a_values A, b b_values B, c c_values C, d d_values D);
several!(a a_values A, b b_values B, c c_values C, d d_values D, e e_values E);
several!(a a_values A, b b_values B, c c_values C, d d_values D, e e_values E, f f_values F);
several!(a a_values A, b b_values B, c c_values C, d d_values D, e e_values E, f f_values F, g g_values G);
