// An edge by its unit normal, larger component p, smaller q: half the pixel's extent along the normal; q; 1 / p, the
// slope of the covered area where it grows linearly; 1 / (2 p q), of its growth over the corners.
highp vec2 edge_extent(highp vec2 normal) {
    highp vec2 n = abs(normal);
    return vec2(0.5 * (n.x + n.y), min(n.x, n.y));
}

highp vec4 edge_of(highp vec2 normal) {
    highp vec2 n = abs(normal);
    highp float p = max(n.x, n.y), q = min(n.x, n.y);
    return vec4(edge_extent(normal), 1.0 / p, q > 1e-4 ? 0.5 / (p * q) : 0.0);
}

// Whether anything is drawn that depends on how far along its line it lies.
#define MEASURED (DASH || TRIM || RAMP || PATTERN)

// Past an end by more px than any fragment lies there.
const highp float NEVER_PX = 1e6;
