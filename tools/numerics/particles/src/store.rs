//! Values of one column, by kind.

/// Values of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Store {
    /// Numbers, `[n]`.
    Scalars(Vec<f64>),
    /// Vectors, `[n][3]`.
    Vectors(Vec<[f64; 3]>),
    /// Matrices by rows, `[n][3][3]`.
    Matrices(Vec<[[f64; 3]; 3]>),
    /// Flags or small numbers, `[n]`.
    Flags(Vec<u8>),
    /// What is or is not, `[n]`.
    Marks(Vec<bool>),
    /// Numbers of identity, `[n]`.
    Ids(Vec<u32>),
}

/// Does the same with the values of any kind.
macro_rules! each {
    ($store:expr, $values:ident => $done:expr) => {
        match $store {
            Store::Scalars($values) => $done,
            Store::Vectors($values) => $done,
            Store::Matrices($values) => $done,
            Store::Flags($values) => $done,
            Store::Marks($values) => $done,
            Store::Ids($values) => $done,
        }
    };
}

impl Store {
    /// Number of values.
    #[must_use]
    pub fn len(&self) -> usize {
        each!(self, values => values.len())
    }

    /// True without values.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes of one value.
    #[must_use]
    pub fn width(&self) -> usize {
        match self {
            Self::Scalars(_) => 8,
            Self::Vectors(_) => 24,
            Self::Matrices(_) => 72,
            Self::Flags(_) | Self::Marks(_) => 1,
            Self::Ids(_) => 4,
        }
    }

    /// An empty store of the same kind.
    #[must_use]
    pub(crate) fn empty(&self) -> Self {
        match self {
            Self::Scalars(_) => Self::Scalars(Vec::new()),
            Self::Vectors(_) => Self::Vectors(Vec::new()),
            Self::Matrices(_) => Self::Matrices(Vec::new()),
            Self::Flags(_) => Self::Flags(Vec::new()),
            Self::Marks(_) => Self::Marks(Vec::new()),
            Self::Ids(_) => Self::Ids(Vec::new()),
        }
    }

    /// Appends the value `row` of another store of the same kind.
    pub(crate) fn append(&mut self, from: &Self, row: usize) {
        match (self, from) {
            (Self::Scalars(to), Self::Scalars(from)) => to.push(from[row]),
            (Self::Vectors(to), Self::Vectors(from)) => to.push(from[row]),
            (Self::Matrices(to), Self::Matrices(from)) => to.push(from[row]),
            (Self::Flags(to), Self::Flags(from)) => to.push(from[row]),
            (Self::Marks(to), Self::Marks(from)) => to.push(from[row]),
            (Self::Ids(to), Self::Ids(from)) => to.push(from[row]),
            (to, from) => unreachable!("one column held as {to:?} and as {from:?}"),
        }
    }

    /// Keeps the rows whose number `keeps` says so, in their order.
    pub(crate) fn retain(&mut self, keeps: impl Fn(usize) -> bool) {
        let mut row = 0..;
        each!(self, values => values.retain(|_| row.next().is_some_and(&keeps)));
    }

    /// Puts the value of the row `order[k]` into the row k, for all k.
    pub(crate) fn arrange(&mut self, order: &[u32]) {
        each!(self, values => {
            let arranged = order.iter().map(|row| values[*row as usize]).collect();
            *values = arranged;
        });
    }

    /// Whether both hold values of one kind.
    #[must_use]
    pub fn alike(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

mod sealed {
    /// Closes [`super::Value`].
    pub trait Sealed {}
}

/// A type that columns may hold.
pub trait Value: Copy + Send + Sync + sealed::Sealed + 'static {
    /// The values of a store of this type.
    fn of(store: &Store) -> Option<&Vec<Self>>;
    /// The same, to be changed.
    fn of_mut(store: &mut Store) -> Option<&mut Vec<Self>>;
    /// A store of values.
    fn store(values: Vec<Self>) -> Store;
}

/// Makes a type one that columns may hold.
macro_rules! value {
    ($type:ty, $kind:ident) => {
        impl sealed::Sealed for $type {}

        impl Value for $type {
            fn of(store: &Store) -> Option<&Vec<Self>> {
                match store {
                    Store::$kind(values) => Some(values),
                    _ => None,
                }
            }

            fn of_mut(store: &mut Store) -> Option<&mut Vec<Self>> {
                match store {
                    Store::$kind(values) => Some(values),
                    _ => None,
                }
            }

            fn store(values: Vec<Self>) -> Store {
                Store::$kind(values)
            }
        }
    };
}

value!(f64, Scalars);
value!([f64; 3], Vectors);
value!([[f64; 3]; 3], Matrices);
value!(u8, Flags);
value!(bool, Marks);
value!(u32, Ids);
