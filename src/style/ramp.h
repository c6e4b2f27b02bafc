/* A line-gradient as stops. */
#ifndef CAMBER_STYLE_RAMP_H
#define CAMBER_STYLE_RAMP_H

#include "style/style.h"

/* Makes the stops of a line-gradient. If the expression cannot be evaluated at a position, nothing is drawn there;
 * *cause is then a phrase with the reason at *failed_at, otherwise NULL. Returns CAMBER_ERROR_MEMORY. Cost: bounded for
 * any expression. */
camber_status camber_layer_ramp_create(const camber_expression *expression, camber_layer_ramp *ramp, const char **cause,
                                       double *failed_at);
/* Makes a ramp with the same stops in other colours. */
camber_status camber_layer_ramp_copy(camber_context *context, const camber_layer_ramp *ramp,
                                     camber_color (*change)(camber_color color), camber_layer_ramp *copy);

#endif
