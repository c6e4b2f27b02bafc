/* Text files that the build embeds in the library (src/embed.cmake). Each text ends with a 0. */
#ifndef CAMBER_BASE_EMBEDDED_H
#define CAMBER_BASE_EMBEDDED_H

extern const char camber_kernels_source[]; /* the kernels of tessellation, as one program */
extern const unsigned long camber_kernels_source_size;
extern const char camber_network_kernels_source[]; /* the kernels that project networks */
extern const unsigned long camber_network_kernels_source_size;
extern const char camber_measure_kernels_source[]; /* the kernels that sum arc lengths */
extern const unsigned long camber_measure_kernels_source_size;
extern const char camber_offset_kernels_source[]; /* the kernels that offset lines */
extern const unsigned long camber_offset_kernels_source_size;
extern const char camber_cover_kernels_source[]; /* the kernels that rasterize */
extern const unsigned long camber_cover_kernels_source_size;
extern const char camber_edge_glsl[]; /* shaders/ without their #version line */
extern const unsigned long camber_edge_glsl_size;
extern const char camber_stroke_vert[], camber_stroke_frag[];
extern const unsigned long camber_stroke_vert_size, camber_stroke_frag_size;
extern const char camber_flatten_vert[], camber_flatten_frag[];
extern const unsigned long camber_flatten_vert_size, camber_flatten_frag_size;
extern const char camber_count_frag[];
extern const unsigned long camber_count_frag_size;
extern const char camber_style_light[], camber_style_dark[]; /* src/style/ */
extern const unsigned long camber_style_light_size, camber_style_dark_size;
extern const char camber_style_openmaptiles_light[], camber_style_openmaptiles_dark[];
extern const unsigned long camber_style_openmaptiles_light_size, camber_style_openmaptiles_dark_size;
extern const char camber_style_transit_light[], camber_style_transit_dark[];
extern const unsigned long camber_style_transit_light_size, camber_style_transit_dark_size;
extern const char camber_osmconf[]; /* src/source/osmconf.ini */
extern const unsigned long camber_osmconf_size;

#endif
