/* Correct homework in another style than lecture.c: the 4x4 block is written
 * out, the loop is endless with a break, and each update fills another array.
 */
static void spring_hess(const Solid *solid, const Vec2 *x, double scale,
                        cholmod_triplet *H)
{
    for (int s = 0; s < solid->springs; s++) {
        Spring e = solid->e[s];
        Vec2 d = sub(x[e.j], x[e.i]);
        double stretch = 2 * e.k / e.l2 * (dot(d, d) - e.l2);
        double D[2][2] = {
            {4 * e.k / e.l2 * d.x * d.x + stretch, 4 * e.k / e.l2 * d.x * d.y},
            {4 * e.k / e.l2 * d.y * d.x, 4 * e.k / e.l2 * d.y * d.y + stretch}};
        double block[4][4] = {{D[0][0], D[0][1], -D[0][0], -D[0][1]},
                              {D[1][0], D[1][1], -D[1][0], -D[1][1]},
                              {-D[0][0], -D[0][1], D[0][0], D[0][1]},
                              {-D[1][0], -D[1][1], D[1][0], D[1][1]}};
        int row[4] = {2 * e.i, 2 * e.i + 1, 2 * e.j, 2 * e.j + 1};
        make_psd(block);
        for (int k = 0; k < 16; k++)
            add_entry(H, row[k % 4], row[k / 4], block[k / 4][k % 4] * scale);
    }
}

static void step_forward(Solid *solid, double h, double tol, int step,
                         FILE *table)
{
    int n = solid->nodes, update = 0;
    size_t size = (size_t)n * sizeof(Vec2);
    Vec2 *x_n = malloc(size), *x_tilde = malloc(size), *p = malloc(size);
    memcpy(x_n, solid->x, size);
    for (int i = 0; i < n; i++) {
        x_tilde[i].x = x_n[i].x + solid->v[i].x * h;
        x_tilde[i].y = x_n[i].y + solid->v[i].y * h;
    }
    while (1) {
        search_dir(solid, solid->x, x_tilde, h, p);
        double r = residual(solid, p, h);
        if (r <= tol)
            break;
        Vec2 *x_new = malloc(size);
        double alpha = line_search(solid, solid->x, p, x_tilde, h, x_new);
        memcpy(solid->x, x_new, size);
        free(x_new);
        if (table != NULL)
            fprintf(table, "%d,%d,%.17g,%.17g\n", step, update, r, alpha);
        update = update + 1;
    }
    for (int i = 0; i < n; i++) {
        solid->v[i].x = (solid->x[i].x - x_n[i].x) / h;
        solid->v[i].y = (solid->x[i].y - x_n[i].y) / h;
    }
    free(x_n);
    free(x_tilde);
    free(p);
}

static void explicit_euler(Solid *solid, double h, bool symplectic)
{
    Vec2 *g = allocate(solid->nodes, sizeof *g);
    spring_grad(solid, solid->x, -1, g);
    for (int i = 0; i < solid->nodes; i++) {
        if (!symplectic)
            solid->x[i] = add(solid->x[i], mul(h, solid->v[i]));
        solid->v[i].x += h * g[i].x / solid->m[i];
        solid->v[i].y += h * g[i].y / solid->m[i];
        if (symplectic)
            solid->x[i] = add(solid->x[i], mul(h, solid->v[i]));
    }
    free(g);
}
