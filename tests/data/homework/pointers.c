/* Runs along arrays with pointers and indices of single numbers. */
static double inertia_val(const Solid *solid, const Vec2 *x,
                          const Vec2 *x_tilde)
{
    const double *a = &x->x, *b = &x_tilde->x;
    double twice = 0;
    for (int i = 0; i < 2 * solid->nodes; i++)
        twice += (a[i] - b[i]) * (a[i] - b[i]) * solid->m[i / 2];
    return twice / 2;
}

static void inertia_grad(const Solid *solid, const Vec2 *x, const Vec2 *x_tilde,
                         Vec2 *g)
{
    double *sum = &g->x;
    for (int i = 2 * solid->nodes - 1; i >= 0; i--)
        sum[i] -= solid->m[i / 2] * ((&x_tilde->x)[i] - (&x->x)[i]);
}

static void inertia_hess(const Solid *solid, cholmod_triplet *H)
{
    for (int i = 0; i < solid->nodes; i++) {
        add_entry(H, 2 * i + 1, 2 * i + 1, solid->m[i]);
        add_entry(H, 2 * i, 2 * i, solid->m[i]);
    }
}

static void make_psd(double hess[4][4])
{
    double q[16], l[4], work[12];
    int four = 4, size = 12, failed;
    for (int i = 0; i < 16; i++)
        q[i] = hess[i / 4][i % 4];
    dsyev_("V", "L", &four, q, &four, l, work, &size, &failed);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 16 && l[i] < 0; k++)
            hess[k / 4][k % 4] -= l[i] * q[4 * i + k / 4] * q[4 * i + k % 4];
}

static double spring_val(const Solid *solid, const Vec2 *x)
{
    double sum = 0;
    for (int s = 0; s < solid->springs; s++) {
        Spring e = solid->e[s];
        double dx = x[e.i].x - x[e.j].x, dy = x[e.i].y - x[e.j].y;
        sum += e.k * pow(dx * dx + dy * dy - e.l2, 2) / e.l2 / 2;
    }
    return sum;
}

static void spring_grad(const Solid *solid, const Vec2 *x, double scale,
                        Vec2 *g)
{
    const Spring *e = solid->e;
    for (int left = solid->springs; left > 0; left--, e++) {
        double dx = x[e->j].x - x[e->i].x, dy = x[e->j].y - x[e->i].y;
        double pull = 2 * e->k * scale * (dx * dx + dy * dy - e->l2) / e->l2;
        g[e->i].x -= pull * dx;
        g[e->i].y -= pull * dy;
        g[e->j].x += pull * dx;
        g[e->j].y += pull * dy;
    }
}

static double line_search(const Solid *solid, const Vec2 *x, const Vec2 *p,
                          const Vec2 *x_tilde, double h, Vec2 *x_new)
{
    double alpha = 2;
    do {
        alpha *= 0.5;
        if (alpha < 1e-19)
            FAIL(1, "E does not fall\n");
        for (int i = 0; i < 2 * solid->nodes; i++)
            (&x_new->x)[i] = (&x->x)[i] + alpha * (&p->x)[i];
    } while (ip_val(solid, x_new, x_tilde, h) > ip_val(solid, x, x_tilde, h));
    return alpha;
}

static double residual(const Solid *solid, const Vec2 *p, double h)
{
    double largest = 0;
    for (int i = 0; i < solid->nodes; i++) {
        double sum = fabs(p[i].x / h) + fabs(p[i].y / h);
        if (sum > largest)
            largest = sum;
    }
    return largest;
}
