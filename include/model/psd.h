/* psd.h - projection of a spring's Hessian to positive semi-definite
 * (slide utils.py, make_PSD), as the slide has it and in closed form; what each
 * spring needs for each Hessian stands here, to be compiled into the loops.
 */
#ifndef ELASTO_PSD_H
#define ELASTO_PSD_H

#include <stdbool.h>

/* What is done with negative eigenvalues of a spring's Hessian block. */
typedef enum Filter {
    FILTER_CLAMP,     /* replace them by 0: the slides' projection */
    FILTER_NONE,      /* keep them */
    FILTER_ABS,       /* replace them by their absolute values */
    FILTER_ON_DEMAND, /* keep them while the whole Hessian has a Cholesky
                         factor, else clamp; for one block: as NONE */
    FILTER_COUNT
} Filter;

/* A, the symmetric 4x4 block, becomes the nearest positive semi-definite
 * matrix in the Frobenius norm: A = Q L Q^T -> Q max(L, 0) Q^T.  A block
 * without negative eigenvalues stays as it is, to the last bit.
 *   a  [16] in/out, row by row
 * Eigenvalues by cyclic Jacobi rotations (Golub, Van Loan: 8.5). */
void make_psd(double a[16]);

/* The spring's 2x2 Hessian H = (2k/l2) (2 d d^T + (|d|^2 - l2) I).  The 4x4
 * block is [[H, -H], [-H, H]]: its eigenvalues are 0, 0 and twice those of H.
 *   d   [2] m, in: x_i - x_j
 *   H   [3] J/m^2, out: H_xx, H_xy, H_yy */
static inline void spring_hessian(const double d[2], double l2, double k,
                                  double H[3])
{
    double factor = 2 * k / l2;
    double d2 = d[0] * d[0] + d[1] * d[1];
    H[0] = factor * (2 * d[0] * d[0] + (d2 - l2));
    H[1] = factor * (2 * d[0] * d[1]);
    H[2] = factor * (2 * d[1] * d[1] + (d2 - l2));
}

/* spring_hessian, projected, without any eigenvalue routine.  Returns whether
 * there was a negative eigenvalue to remove.
 *
 * The eigenvectors of H are d, with eigenvalue (2k/l2) (3|d|^2 - l2), and the
 * one across, with (2k/l2) (|d|^2 - l2).  So with the length alone is known:
 *   |d|^2 >= l2         stretched: both >= 0, nothing to do
 *   |d|^2 >= l2/3       the one across is cut: lambda d d^T / |d|^2 is left
 *   else                both are cut: 0, also for |d| = 0 */
static inline bool spring_hessian_psd(const double d[2], double l2, double k,
                                      double H[3])
{
    double d2 = d[0] * d[0] + d[1] * d[1];
    if (d2 >= l2) {
        spring_hessian(d, l2, k, H);
        return false;
    }
    double factor = 0;
    if (3 * d2 > l2)
        factor = 2 * k / l2 * ((3 * d2 - l2) / d2);
    H[0] = factor * d[0] * d[0];
    H[1] = factor * d[0] * d[1];
    H[2] = factor * d[1] * d[1];
    return true;
}

/* The spring's Hessian H with its negative eigenvalues treated as the filter
 * says.  Returns whether there was one that was changed. */
bool spring_hessian_filtered(const double d[2], double l2, double k,
                             Filter filter, double H[3]);

/* H, any symmetric 2x2 matrix, becomes the nearest positive semi-definite one;
 * unchanged to the last bit if it is that already.
 *   H   [3] in/out: H_xx, H_xy, H_yy
 * Returns whether there was a negative eigenvalue to remove. */
bool make_psd_2x2(double H[3]);

/* The same by absolute values of the eigenvalues. */
bool make_abs_2x2(double H[3]);

/* Either of them, or nothing, as the filter says. */
bool filter_2x2(Filter filter, double H[3]);

#endif
