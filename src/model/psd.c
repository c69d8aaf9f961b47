#include "model/psd.h"

#include <math.h>
#include <string.h>

/* Sum of squares above the diagonal. */
static double off_diagonal(const double a[16])
{
    double sum = 0;
    for (int r = 0; r < 4; r++)
        for (int c = r + 1; c < 4; c++)
            sum += a[4 * r + c] * a[4 * r + c];
    return sum;
}

/* A = J^T A J and Q = Q J with the rotation J in plane (r, c) that makes
 * A_rc = 0: t = tan of the smaller of the two possible angles. */
static void jacobi_rotate(double a[16], double q[16], int r, int c)
{
    double a_rc = a[4 * r + c];
    if (a_rc == 0)
        return;
    double theta = (a[5 * c] - a[5 * r]) / (2 * a_rc);
    double t = copysign(1, theta) / (fabs(theta) + hypot(1, theta));
    double cosine = 1 / hypot(1, t), sine = t * cosine;
    for (int i = 0; i < 4; i++) { /* columns r and c of A and of Q */
        double ar = a[4 * i + r], ac = a[4 * i + c];
        double qr = q[4 * i + r], qc = q[4 * i + c];
        a[4 * i + r] = cosine * ar - sine * ac;
        a[4 * i + c] = sine * ar + cosine * ac;
        q[4 * i + r] = cosine * qr - sine * qc;
        q[4 * i + c] = sine * qr + cosine * qc;
    }
    for (int i = 0; i < 4; i++) { /* rows r and c of A */
        double ar = a[4 * r + i], ac = a[4 * c + i];
        a[4 * r + i] = cosine * ar - sine * ac;
        a[4 * c + i] = sine * ar + cosine * ac;
    }
    a[4 * r + c] = a[4 * c + r] = 0;
}

/* A = Q L Q^T: the eigenvalues end on the diagonal of A, the eigenvectors in
 * the columns of Q.  Convergence is quadratic; 4x4 needs about 5 sweeps. */
static void jacobi_eigen(double a[16], double q[16])
{
    enum { MAX_SWEEPS = 30 };
    for (int i = 0; i < 16; i++)
        q[i] = i % 5 == 0;
    for (int sweep = 0; sweep < MAX_SWEEPS && off_diagonal(a) > 0; sweep++)
        for (int r = 0; r < 4; r++)
            for (int c = r + 1; c < 4; c++)
                jacobi_rotate(a, q, r, c);
}

void make_psd(double a[16])
{
    double l[16], q[16];
    memcpy(l, a, sizeof l);
    jacobi_eigen(l, q);
    /* Eigenvalues that are 0 but for rounding are not negative. */
    double largest = 0;
    bool negative = false;
    for (int i = 0; i < 4; i++)
        largest = fmax(largest, fabs(l[5 * i]));
    for (int i = 0; i < 4; i++)
        negative = negative || l[5 * i] < -1e-15 * largest;
    if (!negative)
        return;
    for (int r = 0; r < 4; r++)
        for (int c = r; c < 4; c++) {
            double sum = 0;
            for (int i = 0; i < 4; i++)
                sum += fmax(l[5 * i], 0) * q[4 * r + i] * q[4 * c + i];
            a[4 * r + c] = a[4 * c + r] = sum;
        }
}

/* Both eigenvectors are known, so the absolute values are at hand:
 * |lambda_d| d d^T/|d|^2 + |lambda_across| (I - d d^T/|d|^2), where for d = 0
 * both are 2k. */
static bool spring_hessian_abs(const double d[2], double l2, double k,
                               double H[3])
{
    double factor = 2 * k / l2;
    double d2 = d[0] * d[0] + d[1] * d[1];
    if (d2 >= l2) {
        spring_hessian(d, l2, k, H);
        return false;
    }
    double along = factor * fabs(3 * d2 - l2), across = factor * (l2 - d2);
    double difference = d2 > 0 ? (along - across) / d2 : 0;
    H[0] = across + difference * d[0] * d[0];
    H[1] = difference * d[0] * d[1];
    H[2] = across + difference * d[1] * d[1];
    return true;
}

bool spring_hessian_filtered(const double d[2], double l2, double k,
                             Filter filter, double H[3])
{
    if (filter == FILTER_CLAMP)
        return spring_hessian_psd(d, l2, k, H);
    if (filter == FILTER_ABS)
        return spring_hessian_abs(d, l2, k, H);
    spring_hessian(d, l2, k, H);
    return false;
}

/* Eigenvalues of a symmetric 2x2 matrix: mean +- radius. */
static void eigenvalues_2x2(const double H[3], double *low, double *high)
{
    double mean = 0.5 * (H[0] + H[2]);
    double radius = hypot(0.5 * (H[0] - H[2]), H[1]);
    *low = mean - radius;
    *high = mean + radius;
}

/* One negative: (H - low I) is the projector on the other eigenvector times
 * (high - low), so high (H - low I)/(high - low) is what remains. */
bool make_psd_2x2(double H[3])
{
    double low, high;
    eigenvalues_2x2(H, &low, &high);
    if (low >= 0)
        return false;
    double factor = high > 0 ? high / (high - low) : 0;
    H[0] = factor * (H[0] - low);
    H[1] = factor * H[1];
    H[2] = factor * (H[2] - low);
    return true;
}

/* With both projectors: |H| = ((high + low) H - 2 high low I)/(high - low). */
bool make_abs_2x2(double H[3])
{
    double low, high;
    eigenvalues_2x2(H, &low, &high);
    if (low >= 0)
        return false;
    bool mixed = high > 0;
    double factor = mixed ? (high + low) / (high - low) : -1;
    double round = mixed ? -2 * high * low / (high - low) : 0;
    H[0] = factor * H[0] + round;
    H[1] = factor * H[1];
    H[2] = factor * H[2] + round;
    return true;
}

bool filter_2x2(Filter filter, double H[3])
{
    if (filter == FILTER_CLAMP)
        return make_psd_2x2(H);
    return filter == FILTER_ABS && make_abs_2x2(H);
}
