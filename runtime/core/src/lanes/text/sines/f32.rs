
/// Up to this |x|, rad, the polynomials are used.
const LIMIT: f64 = 1e4;

// Minimax polynomials on [−π/4, π/4]; coefficients of Cephes' sinf and cosf (S. Moshier).
const S: [f64; 3] = [-1.6666654611e-1, 8.3321608736e-3, -1.9515295891e-4];
const C: [f64; 3] = [4.166664568298827e-2, -1.388731625493765e-3, 2.443315711809948e-5];
