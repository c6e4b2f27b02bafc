/* Text files that the build embeds (src/embed.cmake), each with a 0 behind its end. */
#ifndef CAMBER_EMBEDDED_H
#define CAMBER_EMBEDDED_H

extern const char camber_kernels_source[]; /* kernels/ as one program */
extern const unsigned long camber_kernels_source_size;
extern const char camber_network_kernels_source[]; /* those of networks, as another */
extern const unsigned long camber_network_kernels_source_size;
extern const char camber_measure_kernels_source[]; /* those of measures */
extern const unsigned long camber_measure_kernels_source_size;
extern const char camber_offset_kernels_source[]; /* those of offsets */
extern const unsigned long camber_offset_kernels_source_size;
extern const char camber_cover_kernels_source[]; /* those that draw */
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
extern const char camber_osmconf[]; /* src/gdal/osmconf.ini */
extern const unsigned long camber_osmconf_size;

#endif
