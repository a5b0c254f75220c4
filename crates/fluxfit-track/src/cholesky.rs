//! Four equations with a positive definite matrix.

use fluxfit::motor::PARAMETERS;

/// Solves `a x = b` with a positive definite matrix (Cholesky); none where it is not.
pub(crate) fn solved(a: &[[f64; PARAMETERS]; PARAMETERS], b: &[f64; PARAMETERS]) -> Option<[f64; PARAMETERS]> {
    let mut l = [[0.0; PARAMETERS]; PARAMETERS];
    for i in 0..PARAMETERS {
        for j in 0..=i {
            let rest = (0..j).fold(a[i][j], |rest, k| rest - l[i][k] * l[j][k]);
            if i == j {
                if rest.is_nan() || rest <= 0.0 {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    let mut x = *b;
    for i in 0..PARAMETERS {
        x[i] = (0..i).fold(x[i], |rest, k| rest - l[i][k] * x[k]) / l[i][i];
    }
    for i in (0..PARAMETERS).rev() {
        x[i] = (i + 1..PARAMETERS).fold(x[i], |rest, k| rest - l[k][i] * x[k]) / l[i][i];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_definite_matrix_is_solved_and_an_indefinite_one_refused() {
        let a = [[4.0, 2.0, 0.0, 1.0], [2.0, 5.0, 1.0, 0.0], [0.0, 1.0, 3.0, 0.5], [1.0, 0.0, 0.5, 2.0]];
        let x = [1.0, -2.0, 0.5, 3.0];
        let b = a.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum());
        assert!(solved(&a, &b).unwrap().iter().zip(x).all(|(found, x)| (found - x).abs() < 1e-12));
        let mut indefinite = a;
        indefinite[2][2] = -1.0;
        assert_eq!(solved(&indefinite, &b), None);
    }
}
