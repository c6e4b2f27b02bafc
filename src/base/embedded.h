/* Files that the build embeds in the library (src/embed.cmake). Each file is followed by a 0. */
#ifndef CAMBER_BASE_EMBEDDED_H
#define CAMBER_BASE_EMBEDDED_H

/* The programs of kernels/, each with everything that it includes. */
extern const char camber_tessellate_kernels[], camber_cull_kernels[], camber_arc_length_kernels[];
extern const unsigned long camber_tessellate_kernels_size, camber_cull_kernels_size, camber_arc_length_kernels_size;
extern const char camber_offset_kernels[], camber_raster_kernels[];
extern const unsigned long camber_offset_kernels_size, camber_raster_kernels_size;
/* The files of shaders/ without their #version lines, each with everything that it includes. */
extern const char camber_stroke_vert[], camber_stroke_frag[];
extern const unsigned long camber_stroke_vert_size, camber_stroke_frag_size;
extern const char camber_flatten_vert[], camber_flatten_frag[];
extern const unsigned long camber_flatten_vert_size, camber_flatten_frag_size;
extern const char camber_images_frag[], camber_count_frag[];
extern const unsigned long camber_images_frag_size, camber_count_frag_size;
extern const char camber_style_city_light[], camber_style_city_dark[]; /* src/style/ */
extern const unsigned long camber_style_city_light_size, camber_style_city_dark_size;
extern const char camber_style_city_osm_light[], camber_style_city_osm_dark[];
extern const unsigned long camber_style_city_osm_light_size, camber_style_city_osm_dark_size;
extern const char camber_style_roads_light[], camber_style_roads_dark[];
extern const unsigned long camber_style_roads_light_size, camber_style_roads_dark_size;
extern const char camber_style_openmaptiles_light[], camber_style_openmaptiles_dark[];
extern const unsigned long camber_style_openmaptiles_light_size, camber_style_openmaptiles_dark_size;
extern const char camber_style_transit_light[], camber_style_transit_dark[];
extern const unsigned long camber_style_transit_light_size, camber_style_transit_dark_size;
/* src/text/fonts/ */
extern const unsigned char camber_font_regular[], camber_font_bold[], camber_font_italic[];
extern const unsigned long camber_font_regular_size, camber_font_bold_size, camber_font_italic_size;
extern const char camber_osmconf[]; /* src/gdal/osmconf.ini */
extern const unsigned long camber_osmconf_size;

#endif
