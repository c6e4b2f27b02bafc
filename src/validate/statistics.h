/* Quantiles of a series of measurements. */
#ifndef CAMBER_VALIDATE_STATISTICS_H
#define CAMBER_VALIDATE_STATISTICS_H

#include <stddef.h>

/* Sorts in ascending order, in place. */
void camber_statistics_sort(double *values, size_t count);
/* Returns a quantile of sorted values: share 0 is the smallest, 1 the largest; interpolated linearly. count: 1 or
 * more. */
double camber_statistics_quantile(const double *sorted, size_t count, double share);
/* Sorts values and returns their median; the mean of the middle two if count is even. count: 1 or more. */
double camber_statistics_median(double *values, size_t count);

#endif
