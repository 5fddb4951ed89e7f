//! What operators err by and with which order: measured over the levels 1 to 3, errors at the third.
//!
//! Root of the mean square and largest error of the gradient, then of the Laplacian, over the largest derivative. A root of
//! mean squares has the order of the fit, or half an order more where what is one-sided lies at the border alone. The
//! largest error lies there, and is the largest of as many draws as there are points on the border: where places are drawn,
//! it falls by less than the order while their number grows, up to the bound that supports keep.

/// Method, errors, orders.
pub type Measured = (&'static str, &'static [f64], &'static [f64]);

/// All of them.
pub const MEASURED: [Measured; 48] = [
    ("plane-1-regular", &[6.18e-4, 1.23e-2], &[1.54, 1.01]),
    ("plane-1-jitter-10", &[6.72e-4, 1.27e-2], &[1.50, 0.95]),
    ("plane-1-jitter-30", &[9.65e-4, 1.47e-2], &[1.35, 0.89]),
    ("plane-1-graded", &[8.52e-4, 1.96e-2], &[1.56, 1.02]),
    ("plane-1-half", &[2.09e-3, 1.71e-2], &[1.13, 0.88]),
    ("plane-1-near-coplanar", &[7.20e-4, 1.27e-2], &[1.49, 0.95]),
    (
        "plane-2-regular",
        &[2.82e-5, 1.83e-4, 2.15e-3, 2.69e-2],
        &[2.13, 1.97, 1.48, 0.98],
    ),
    (
        "plane-2-jitter-10",
        &[2.85e-5, 2.01e-4, 2.22e-3, 2.94e-2],
        &[2.13, 1.95, 1.45, 0.93],
    ),
    (
        "plane-2-jitter-30",
        &[3.07e-5, 2.79e-4, 2.42e-3, 3.10e-2],
        &[2.11, 1.67, 1.36, 0.84],
    ),
    (
        "plane-2-graded",
        &[4.31e-5, 2.83e-4, 2.19e-3, 3.01e-2],
        &[2.11, 1.96, 1.46, 0.98],
    ),
    (
        "plane-2-half",
        &[5.34e-5, 3.56e-4, 4.40e-3, 3.03e-2],
        &[1.98, 1.88, 1.14, 0.89],
    ),
    (
        "plane-2-near-coplanar",
        &[2.86e-5, 1.94e-4, 2.22e-3, 2.81e-2],
        &[2.13, 1.93, 1.46, 0.95],
    ),
    (
        "plane-3-regular",
        &[2.52e-7, 5.05e-6, 6.77e-5, 8.91e-4],
        &[3.57, 2.97, 2.36, 2.00],
    ),
    (
        "plane-3-jitter-10",
        &[2.63e-7, 5.38e-6, 6.85e-5, 9.05e-4],
        &[3.54, 2.81, 2.37, 1.91],
    ),
    (
        "plane-3-jitter-30",
        &[3.23e-7, 7.33e-6, 7.56e-5, 1.09e-3],
        &[3.49, 2.84, 2.40, 1.97],
    ),
    (
        "plane-3-graded",
        &[5.59e-7, 1.15e-5, 7.90e-5, 1.21e-3],
        &[3.45, 3.00, 2.45, 1.93],
    ),
    (
        "plane-3-half",
        &[1.56e-6, 8.82e-6, 3.01e-4, 1.23e-3],
        &[3.03, 2.81, 2.03, 1.86],
    ),
    (
        "plane-3-near-coplanar",
        &[2.80e-7, 5.37e-6, 6.88e-5, 9.05e-4],
        &[3.54, 2.96, 2.38, 1.91],
    ),
    (
        "plane-4-regular",
        &[8.11e-9, 1.04e-7, 1.33e-6, 1.95e-5],
        &[4.41, 3.92, 3.48, 2.92],
    ),
    (
        "plane-4-jitter-10",
        &[8.21e-9, 1.64e-7, 1.48e-6, 2.34e-5],
        &[4.42, 3.79, 3.50, 2.87],
    ),
    (
        "plane-4-jitter-30",
        &[9.53e-9, 3.62e-7, 1.80e-6, 4.90e-5],
        &[4.41, 3.58, 3.45, 2.78],
    ),
    (
        "plane-4-graded",
        &[2.88e-8, 5.77e-7, 2.52e-6, 7.02e-5],
        &[4.27, 3.87, 3.33, 2.36],
    ),
    (
        "plane-4-half",
        &[4.37e-8, 3.06e-7, 8.33e-6, 3.83e-5],
        &[3.95, 3.78, 2.98, 2.87],
    ),
    (
        "plane-4-near-coplanar",
        &[8.21e-9, 1.63e-7, 1.50e-6, 2.31e-5],
        &[4.46, 3.78, 3.56, 3.02],
    ),
    ("space-1-regular", &[2.33e-3, 3.64e-2], &[1.59, 1.03]),
    ("space-1-jitter-10", &[2.38e-3, 3.85e-2], &[1.58, 1.02]),
    ("space-1-jitter-30", &[2.67e-3, 4.37e-2], &[1.52, 0.99]),
    ("space-1-graded", &[3.19e-3, 5.76e-2], &[1.61, 1.03]),
    ("space-1-half", &[4.91e-3, 4.80e-2], &[1.27, 0.92]),
    ("space-1-near-coplanar", &[2.38e-3, 3.85e-2], &[1.58, 1.02]),
    (
        "space-2-regular",
        &[2.37e-4, 1.61e-3, 7.05e-3, 6.13e-2],
        &[2.12, 1.92, 1.46, 0.96],
    ),
    (
        "space-2-jitter-10",
        &[2.37e-4, 1.63e-3, 6.87e-3, 6.53e-2],
        &[2.11, 1.83, 1.46, 0.88],
    ),
    (
        "space-2-jitter-30",
        &[2.47e-4, 2.53e-3, 6.32e-3, 6.34e-2],
        &[2.09, 1.58, 1.45, 0.99],
    ),
    (
        "space-2-graded",
        &[3.62e-4, 2.76e-3, 7.01e-3, 6.82e-2],
        &[2.07, 1.80, 1.46, 0.99],
    ),
    (
        "space-2-half",
        &[3.71e-4, 3.72e-3, 9.44e-3, 7.16e-2],
        &[2.00, 1.64, 1.25, 0.83],
    ),
    (
        "space-2-near-coplanar",
        &[2.36e-4, 1.63e-3, 6.70e-3, 6.53e-2],
        &[2.09, 1.83, 1.41, 0.87],
    ),
    (
        "space-3-regular",
        &[5.83e-6, 8.69e-5, 4.52e-4, 4.57e-3],
        &[3.54, 2.97, 2.47, 1.92],
    ),
    (
        "space-3-jitter-10",
        &[6.98e-6, 1.28e-4, 5.07e-4, 4.23e-3],
        &[3.50, 3.26, 2.45, 2.18],
    ),
    (
        "space-3-jitter-30",
        &[6.49e-6, 1.55e-4, 5.09e-4, 6.72e-3],
        &[3.51, 2.88, 2.42, 2.08],
    ),
    (
        "space-3-graded",
        &[1.41e-5, 4.57e-4, 7.23e-4, 1.60e-2],
        &[3.30, 2.35, 2.22, 1.03],
    ),
    (
        "space-3-half",
        &[2.06e-5, 3.52e-4, 1.29e-3, 9.85e-3],
        &[3.06, 2.39, 2.05, 1.68],
    ),
    (
        "space-3-near-coplanar",
        &[6.76e-6, 1.28e-4, 5.06e-4, 4.23e-3],
        &[3.42, 2.71, 2.37, 1.94],
    ),
    (
        "space-4-regular",
        &[6.50e-7, 7.31e-6, 2.49e-5, 3.40e-4],
        &[4.30, 3.97, 3.43, 2.74],
    ),
    (
        "space-4-jitter-10",
        &[5.30e-7, 1.29e-5, 4.21e-5, 7.14e-4],
        &[4.40, 3.67, 3.30, 2.46],
    ),
    (
        "space-4-jitter-30",
        &[3.21e-7, 1.11e-5, 2.23e-5, 4.29e-4],
        &[4.58, 4.37, 3.46, 2.49],
    ),
    (
        "space-4-graded",
        &[8.81e-7, 3.92e-5, 4.98e-5, 1.18e-3],
        &[4.25, 3.36, 3.35, 2.23],
    ),
    (
        "space-4-half",
        &[1.92e-6, 2.73e-5, 8.47e-5, 7.82e-4],
        &[3.84, 3.69, 2.96, 2.70],
    ),
    (
        "space-4-near-coplanar",
        &[5.48e-7, 1.29e-5, 4.23e-5, 6.85e-4],
        &[4.37, 3.62, 3.31, 2.74],
    ),
];
