/* Guesses whether GL can be hardware here: opening GL only to learn that it is a software rasterizer can cost more than
 * drawing the picture. */
#include "gl/surface.h"

#include "gpu/hardware.h"

bool camber_surface_may_be_hardware(const camber_surface_desc *desc) {
    if (desc && desc->backend == CAMBER_BACKEND_OSMESA)
        return false;
    return (desc && desc->egl_context) || camber_hardware_is_here();
}
