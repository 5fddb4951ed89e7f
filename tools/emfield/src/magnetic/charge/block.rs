//! Approximate solution of one part of the equations of A and V, by multigrid or sparse factors.

use krylov::{
    Coefficient, Direct, Error, Grids, Inverse, Method, Multigrid, Options, Order, Rows, Scalar,
};

/// Factors of one part of the equations.
enum Way<S: Scalar> {
    Grids(Box<Multigrid<f64, S>>),
    Direct(Box<Direct<S>>),
}

/// Approximate solution of one part, in an order of its own.
pub struct Block<S: Scalar> {
    order: Order,
    way: Way<S>,
    given: Vec<S>,
    found: Vec<S>,
}

impl<S: Scalar> Block<S>
where
    f64: Coefficient<S>,
    f32: Coefficient<S>,
{
    /// Factors of `rows + diag(shift)`, where these are fluxes by the given `sizes`: multiplied by them, rows of many
    /// neighbours add up to about what passes the border of these.
    ///
    /// # Errors
    /// Where a coefficient is no number, or the rows are singular.
    pub fn new(
        rows: &Rows<f64>,
        sizes: &[f64],
        shift: &[S],
        options: &Options,
    ) -> Result<Self, Error> {
        let n = rows.len();
        let direct = match options.method {
            Method::Direct => true,
            Method::Chosen => n <= options.direct,
            _ => false,
        };
        let (order, way);
        if direct {
            order = Order::natural(n);
            way = Way::Direct(Box::new(Direct::new(rows, shift)?));
        } else {
            order = Order::cuthill_mckee(rows);
            let mut mixed = vec![S::ZERO; n];
            order.forth(shift, &mut mixed);
            let grids = match options.method {
                Method::Multigrid(grids) => grids,
                _ => Grids::default(),
            };
            let rows = rows.permuted(&order);
            let mut fluxes = vec![0.0; n];
            order.forth(sizes, &mut fluxes);
            let made = Multigrid::<f64, S>::of_fluxes(&rows, &mixed, &order, fluxes, grids)?;
            way = Way::Grids(Box::new(made));
        }
        Ok(Self {
            order,
            way,
            given: Vec::new(),
            found: Vec::new(),
        })
    }
}

impl<S: Scalar, const K: usize> Inverse<S, K> for Block<S>
where
    f64: Coefficient<S>,
    f32: Coefficient<S>,
{
    fn invert(&mut self, given: &[[S; K]], found: &mut [[S; K]]) {
        self.given.resize(K * given.len(), S::ZERO);
        self.found.resize(K * given.len(), S::ZERO);
        let own = self.given.as_chunks_mut::<K>().0;
        let out = self.found.as_chunks_mut::<K>().0;
        self.order.forth(given, own);
        match &mut self.way {
            Way::Grids(grids) => grids.invert(own, out),
            Way::Direct(factors) => factors.invert(own, out),
        }
        self.order.back(out, found);
    }
}
