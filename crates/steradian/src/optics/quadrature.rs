//! Nodes for integrals of smooth functions over an interval.

/// A node of a rule: where the function is taken, and its share in the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Abscissa.
    pub x: f64,
    /// Weight; the weights of a rule add up to the length of its interval.
    pub weight: f64,
}

/// Gauss' rule with `count` nodes, at least 1, on [from, to], which are all inside; exact for polynomials up to the degree
/// 2 `count` − 1. Nodes increase.
pub fn gauss(count: usize, from: f64, to: f64) -> Vec<Node> {
    let n = count.max(1);
    let node = |i: usize| {
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..STEPS {
            let p = Legendre::at(n, x);
            slope = p.slope(n, x);
            x -= p.last / slope;
        }
        Node { x, weight: 2.0 / ((1.0 - x * x) * slope * slope) }
    };
    (0..n).map(|i| mapped(node(i), from, to)).collect()
}

/// Radau's rule with `count` nodes, at least 1, on [from, to], of which the last is `to`; exact for polynomials up to the
/// degree 2 `count` − 2. Nodes increase.
pub fn radau(count: usize, from: f64, to: f64) -> Vec<Node> {
    let n = count.max(1);
    let square = (n * n) as f64;
    let node = |i: usize| {
        let k = n - 1 - i;
        if k == 0 {
            return Node { x: 1.0, weight: 2.0 / square };
        }
        // Roots of P₍ₙ₋₁₎ − Pₙ.
        let mut x = (std::f64::consts::TAU * k as f64 / (2 * n - 1) as f64).cos();
        for _ in 0..STEPS {
            let p = Legendre::at(n, x);
            let before = p.previous - p.last;
            let slope = Legendre::at(n - 1, x).slope(n - 1, x) - p.slope(n, x);
            x -= before / slope;
        }
        let p = Legendre::at(n - 1, x).last;
        Node { x, weight: (1.0 + x) / (square * p * p) }
    };
    (0..n).map(|i| mapped(node(i), from, to)).collect()
}

/// Newton's steps from the asymptotic positions, which are off by less than a tenth of the distance of nodes.
const STEPS: usize = 8;

fn mapped(node: Node, from: f64, to: f64) -> Node {
    let half = 0.5 * (to - from);
    // The end itself, without rounding.
    let x = if node.x == 1.0 { to } else { from + half * (1.0 + node.x) };
    Node { x, weight: node.weight * half }
}

/// The polynomials of Legendre of degrees n and n − 1 at a point.
struct Legendre {
    last: f64,
    previous: f64,
}

impl Legendre {
    fn at(n: usize, x: f64) -> Self {
        let (mut last, mut previous) = (1.0, 0.0);
        for k in 1..=n {
            let k = k as f64;
            (last, previous) = (((2.0 * k - 1.0) * x * last - (k - 1.0) * previous) / k, last);
        }
        Self { last, previous }
    }

    /// The derivative of the one of degree n, inside of (−1, 1).
    fn slope(&self, n: usize, x: f64) -> f64 {
        n as f64 * (x * self.last - self.previous) / (x * x - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(rule: &[Node], degree: i32) -> f64 {
        rule.iter().map(|n| n.weight * n.x.powi(degree)).sum()
    }

    #[test]
    fn rules_are_exact_up_to_their_degree_and_no_further() {
        for n in [1, 2, 3, 8, 33] {
            for (rule, exact) in
                [(gauss(n, 0.0, 1.0), 2 * n as i32 - 1), (radau(n, 0.0, 1.0), 2 * n as i32 - 2)]
            {
                let error = |degree: i32| (integral(&rule, degree) * f64::from(degree + 1) - 1.0).abs();
                assert!((0..=exact).all(|d| error(d) < 1e-13), "{n}");
                assert!(n > 8 || error(exact + 1) > 1e-13, "{n}");
                assert!(rule.windows(2).all(|w| w[0].x < w[1].x));
            }
            assert_eq!(radau(n, 0.2, 0.7).last().unwrap().x, 0.7);
        }
        let shifted: f64 = gauss(20, 1.0, 3.0).iter().map(|n| n.weight / n.x).sum();
        assert!((shifted - 3.0_f64.ln()).abs() < 1e-13);
    }
}
