#include "validate/statistics.h"

#include <stdlib.h>
#include <string.h>

static int ascending(const void *a, const void *b) {
    double x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

void camber_statistics_sort(double *values, size_t count) {
    qsort(values, count, sizeof *values, ascending);
}

double camber_statistics_quantile(const double *sorted, size_t count, double share) {
    const double rank = share * (double)(count - 1);
    const size_t before = (size_t)rank < count - 1 ? (size_t)rank : count - 1;
    if (before == count - 1)
        return sorted[before];
    const double part = rank - (double)before;
    return sorted[before] + part * (sorted[before + 1] - sorted[before]);
}

double camber_statistics_median(double *values, size_t count) {
    camber_statistics_sort(values, count);
    return camber_statistics_quantile(values, count, 0.5);
}
