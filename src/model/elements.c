/* elements.c - the functions of terms that are sums over elements. */
#include "model/elements.h"

#include <math.h>

ElementIterator elements_begin(const EvalPoint *at, const double *p,
                               double alpha)
{
    const ElementKind *kind = at->term->kind->element;
    double most = 0;
    for (int i = 0; p && i < 2 * at->system->nodes; i++)
        most = fabs(p[i]) > most ? fabs(p[i]) : most;
    if (kind->find_elements)
        kind->find_elements(at, p, alpha);
    /* The change of a is alpha |sum w_k p_k|: sum |w_k| is at most 2, and |p_k|
     * at most 1.5 times its larger coordinate. */
    double way = 3 * alpha * most;
    return (ElementIterator){at, kind, way, -1, kind->count_elements(at), {0}};
}

bool elements_next(ElementIterator *walk)
{
    while (walk->element.search_cursor > 0 || ++walk->i < walk->element_count)
        if (walk->kind->get_element(walk->eval_point, walk->i,
                                    walk->motion_bound, &walk->element))
            return true;
    return false;
}

/* Adds factor times g, a vector of an element, to out, a vector of all nodes.
 *   g    [4] in, gradient or Hessian product in the element's vectors a and b
 *   out  [2n] in/out, gradient or Hessian product in the nodes' positions */
static void element_assemble_vector(const Element *element, double factor,
                                    const double g[4], double *out)
{
    for (int i = 0; i < 2 * element->node_count; i++) {
        double sum = 0;
        for (int m = 0; m < element->vector_count; m++)
            sum += element->node_weight[m][i / 2] * g[2 * m + i % 2];
        out[2 * element->node[i / 2] + i % 2] += factor * sum;
    }
}

double elements_potential(const EvalPoint *at)
{
    double sum = 0;
    for (ElementIterator walk = elements_begin(at, NULL, 0);
         elements_next(&walk);)
        sum += walk.kind->potential(at, &walk.element);
    return sum;
}

void elements_gradient(const EvalPoint *at, double *g)
{
    double own[4];
    for (ElementIterator walk = elements_begin(at, NULL, 0);
         elements_next(&walk);) {
        walk.kind->gradient(at, &walk.element, own);
        element_assemble_vector(&walk.element, walk.element.derivative_factor,
                                own, g);
    }
}

/* Number of 2x2 parts of a block of 3 nodes, and the two nodes of each part. */
enum { NODE_PAIR_COUNT = 6 };
static const int part[NODE_PAIR_COUNT][2] = {{0, 0}, {1, 1}, {2, 2},
                                             {0, 1}, {0, 2}, {1, 2}};

/* Returns the number of triplets of a block, the same for every block. */
static int count_block_entries(const EvalPoint *at)
{
    int node[3], nodes = at->term->kind->element->get_block_nodes(at, 0, node);
    return nodes * (2 * nodes + 1);
}

void elements_add_triplets(const EvalPoint *at, Triplets *triplets)
{
    const ElementKind *kind = at->term->kind->element;
    int node[3], blocks = kind->count_blocks(at);
    for (int b = 0; b < blocks; b++) {
        int nodes = kind->get_block_nodes(at, b, node);
        for (int i = 0; i < NODE_PAIR_COUNT; i++)
            if (part[i][1] < nodes)
                add_block_triplets(at->system, node[part[i][0]],
                                   node[part[i][1]], triplets);
    }
}

/* Adds an element's block: for nodes k and l, derivative_factor times the sum
 * of w_mk w_nl H_mn over vectors m and n, with node weights w and 2x2 parts of
 * H.  The function is inline so that the compiler unrolls the loops. */
static inline void element_add_hessian(const Element *element, int vectors,
                                       double H[4][4], const int *slot,
                                       double *out)
{
    for (int i = 0; i < NODE_PAIR_COUNT; i++) {
        int k = part[i][0], l = part[i][1];
        if (l >= element->node_count)
            continue;
        for (int r = 0; r < 2; r++)
            for (int c = k == l ? r : 0; c < 2; c++) {
                double sum = 0;
                for (int n = 0; n < vectors; n++) {
                    double column = 0;
                    for (int m = 0; m < vectors; m++)
                        column += element->node_weight[m][k] *
                                  H[2 * m + r][2 * n + c];
                    sum += element->node_weight[n][l] * column;
                }
                out[*slot++] += element->derivative_factor * sum;
            }
    }
}

/* Adds the product of an element's Hessian with q [2n] to out [2n]. */
static bool element_add_hessian_product(const ElementIterator *walk,
                                        Projection projection, const double *q,
                                        double *out)
{
    const Element *element = &walk->element;
    double H[4][4], v[4], Hv[4] = {0};
    bool changed;
    element_compute_vectors(element, q, v);
    if (walk->kind->apply_hessian) {
        changed = walk->kind->apply_hessian(walk->eval_point, element,
                                            projection, v, Hv);
    } else {
        changed = walk->kind->hessian(walk->eval_point, element, projection, H);
        for (int r = 0; r < 2 * element->vector_count; r++)
            for (int c = 0; c < 2 * element->vector_count; c++)
                Hv[r] += H[r][c] * v[c];
    }
    element_assemble_vector(element, element->derivative_factor, Hv, out);
    return changed;
}

int elements_hessian(const EvalPoint *at, Projection projection,
                     const int **slot, const double *q, double *out)
{
    int projected = 0, entries = count_block_entries(at);
    double H[4][4];
    for (ElementIterator walk = elements_begin(at, NULL, 0);
         elements_next(&walk);) {
        const Element *element = &walk.element;
        if (q) {
            projected += element_add_hessian_product(&walk, projection, q, out);
            continue;
        }
        projected += walk.kind->hessian(at, element, projection, H);
        const int *first = *slot + entries * element->block_index;
        if (element->vector_count == 1)
            element_add_hessian(element, 1, H, first, out);
        else
            element_add_hessian(element, 2, H, first, out);
    }
    if (!q)
        *slot += entries * at->term->kind->element->count_blocks(at);
    return projected;
}

double elements_taylor_remainder(const EvalPoint *at, const double *p,
                                 double alpha)
{
    double sum = 0, P[4];
    for (ElementIterator walk = elements_begin(at, p, alpha);
         elements_next(&walk);) {
        element_compute_vectors(&walk.element, p, P);
        sum += walk.kind->taylor_remainder(at, &walk.element, P, alpha);
    }
    return at->weight * sum;
}

double elements_max_alpha(const EvalPoint *at, const double *p)
{
    double smallest = INFINITY, P[4];
    ElementIterator walk = elements_begin(at, p, 1);
    while (walk.kind->max_alpha && elements_next(&walk)) {
        element_compute_vectors(&walk.element, p, P);
        double alpha = walk.kind->max_alpha(at, &walk.element, P);
        smallest = alpha <= 1 ? fmin(smallest, alpha) : smallest;
    }
    return smallest;
}

bool elements_are_feasible(const EvalPoint *at)
{
    ElementIterator walk = elements_begin(at, NULL, 0);
    while (walk.kind->max_alpha && elements_next(&walk))
        if (!(walk.element.s > 0))
            return false;
    return true;
}
