/* Icons of an operator's own: a sprite, as styles have it. Overlays draw them as markers. */
#ifndef CAMBER_SERVE_ICONS_H
#define CAMBER_SERVE_ICONS_H

#include <stdbool.h>

typedef struct camber_overlay_icons camber_overlay_icons;

/* sprite: the path of its files without their endings, .json and .png. Returns an errno; EINVAL: no icons listed. */
int camber_overlay_icons_create(const char *sprite, camber_overlay_icons **icons);
void camber_overlay_icons_destroy(camber_overlay_icons *icons);
const char *camber_overlay_icons_get_sprite(const camber_overlay_icons *icons);
bool camber_overlay_icons_has(const camber_overlay_icons *icons, const char *name);
/* Each overlay with icons decodes the sprite. Returns icons, or NULL if too many of them wait already; one may always.
 * Any thread may call it. Release what it returns. */
camber_overlay_icons *camber_overlay_icons_hold(camber_overlay_icons *icons);
void camber_overlay_icons_release(camber_overlay_icons *icons);

#endif
