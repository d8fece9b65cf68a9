// The directions in which texture coordinates of either set grow.
#import core/layout.wgsl
#import geometry/shape_point.wgsl
#import shading/shapes.wgsl
#import shading/texture/attributes.wgsl

// The tangents by the first or the second coordinates; shapes with one set have those of that. `first` may be
// NONE.
fn tangents_of_set(kind: u32, first: u32, point: ShapePoint, by_second: bool) -> Tangents {
#if SECOND_UVS
    if by_second && first != NONE && kind == KIND_TRIANGLE {
        return edge_tangents(first + 1u, point.along_u, point.along_v);
    }
#endif
    return shape_tangents(kind, first, point);
}
