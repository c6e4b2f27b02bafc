/* Quantiles of a series of measurements. */
#ifndef CAMBER_VALIDATE_STATISTICS_H
#define CAMBER_VALIDATE_STATISTICS_H

#include <stddef.h>

/* Ascending, in place. */
void camber_statistics_sort(double *values, size_t count);
/* Quantile of sorted values: share 0 is the least, 1 the largest; linear between two values. count: 1 or more. */
double camber_statistics_quantile(const double *sorted, size_t count, double share);
/* Sorts values and gives their median: of an even number the mean of the middle two. count: 1 or more. */
double camber_statistics_median(double *values, size_t count);

#endif
