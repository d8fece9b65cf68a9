// closest_hit and occluded, wherever the plan put the geometry.
#if BVH
#import geometry/traversal.wgsl
#else
#if RAY_QUERY
#import geometry/ray_query.wgsl
#else
#import geometry/unrolled.wgsl
#endif
#endif
