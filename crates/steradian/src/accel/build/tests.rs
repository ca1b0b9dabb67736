use super::*;
use crate::accel::tree::{Item, LANES, MAX_DEPTH, Members, Owner, Target, WIDTH};
use crate::math::{Point, Transform, Vec3};
use crate::shape::{MeshData, Orientation, TriangleMesh};

fn mesh(positions: Vec<Point>, indices: Vec<[u32; 3]>) -> Shape {
    let data = MeshData { positions, indices, ..Default::default() };
    Shape::Mesh(TriangleMesh::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap())
}

/// A number in [0, 1) that looks random.
fn noise(i: u32) -> f32 {
    let x = i.wrapping_mul(0x9e37_79b9);
    let x = (x ^ x >> 15).wrapping_mul(0x85eb_ca6b);
    ((x ^ x >> 13) >> 8) as f32 / 16_777_216.0
}

fn scattered(i: u32) -> Vec3 {
    Vec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2)) * 2.0 - 1.0
}

/// Triangles that share no vertices.
fn soup(count: u32, triangle: impl Fn(u32) -> [Vec3; 3]) -> Shape {
    let positions = (0..count).flat_map(|i| triangle(i).map(Point)).collect();
    mesh(positions, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// A wavy height field of 2 n² triangles with shared vertices.
fn terrain(n: u32) -> Shape {
    let height = |x: f32, y: f32| 0.05 * (17.0 * x).sin() * (23.0 * y).cos();
    let point = |i: u32| {
        let (x, y) = ((i % (n + 1)) as f32 / n as f32, (i / (n + 1)) as f32 / n as f32);
        Point::new(x, height(x, y), y)
    };
    let faces = (0..n * n).flat_map(|i| {
        let a = i / n * (n + 1) + i % n;
        [[a, a + 1, a + n + 1], [a + 1, a + n + 2, a + n + 1]]
    });
    let faces = faces.collect();
    mesh((0..(n + 1) * (n + 1)).map(point).collect(), faces)
}

fn tree_of(shapes: &[Shape]) -> Tree {
    let ids: Vec<ShapeId> = (0..shapes.len() as u32).map(ShapeId).collect();
    build(shapes, &Layout::default(), &ids, &[]).unwrap()
}

/// Walks a tree: boxes contain what is below them, every node, packet and item is reached once, and no level is below
/// the deepest that the tree admits to. Returns the (shape, primitive) of all triangles in order.
fn walked(tree: &Tree) -> Vec<(ShapeId, u32)> {
    let mut found = Vec::new();
    let mut reached = (0, 0);
    let mut reached_items = vec![0; tree.items.len()];
    let mut work = vec![(0_u32, tree.bounds.unwrap_or(Bounds3::EMPTY), 1)];
    let inside = |inner: &Bounds3, outer: &Bounds3| {
        inner.min.cmpge(*outer.min).all() && inner.max.cmple(*outer.max).all()
    };
    while let Some((index, reach, depth)) = work.pop() {
        reached.0 += 1;
        assert!(depth <= tree.depth && tree.depth <= MAX_DEPTH, "{depth} {}", tree.depth);
        let node = &tree.nodes[index as usize];
        for slot in 0..WIDTH {
            let Some(b) = node.child_bounds(slot) else { continue };
            assert!(inside(&b, &reach), "{b:?} {reach:?}");
            match node.children[slot].target() {
                Target::Inner(i) => work.push((i, b, depth + 1)),
                Target::Packets { first, count } => {
                    for p in &tree.packets[first as usize..(first + count) as usize] {
                        reached.1 += 1;
                        for lane in (0..LANES).filter(|&l| p.owners[l] != Owner::NONE) {
                            assert!(inside(&Bounds3::from_points(p.triangle(lane)), &b));
                            found.push((p.owners[lane].shape(), p.prims[lane]));
                        }
                    }
                }
                Target::Item(i) => reached_items[i as usize] += 1,
                Target::Bunch(i) => {
                    let Members { first, count } = tree.members[i as usize];
                    (first..first + count).for_each(|k| reached_items[k as usize] += 1);
                }
            }
        }
    }
    assert_eq!(reached, (tree.nodes.len(), tree.packets.len()));
    assert!(reached_items.iter().all(|n| *n == 1), "every item lies in one leaf");
    found.sort_unstable();
    found
}

fn assert_holds_all(shapes: &[Shape]) -> Tree {
    let tree = tree_of(shapes);
    let all = |(i, s): (usize, &Shape)| (0..s.prim_count()).map(move |p| (ShapeId(i as u32), p));
    assert_eq!(walked(&tree), shapes.iter().enumerate().flat_map(all).collect::<Vec<_>>());
    tree
}

#[test]
fn every_triangle_lies_in_one_leaf_whatever_the_triangles() {
    let small = |c: Vec3, size: f32| [c, c + Vec3::X * size, c + Vec3::new(0.1, 1.0, 0.3) * size];
    let cases: Vec<(&str, Shape)> = vec![
        ("one", soup(1, |i| small(scattered(i), 0.1))),
        ("a packet and one", soup(5, |i| small(scattered(i), 0.1))),
        ("scattered", soup(20_000, |i| small(scattered(i), 0.01))),
        ("of all sizes", soup(20_000, |i| small(scattered(i), 3.0 * noise(i).powi(12)))),
        ("coincident", soup(100_000, |_| small(Vec3::ONE, 1.0))),
        ("points", soup(5000, |_| [Vec3::ZERO; 3])),
        ("centres on a line", soup(5000, |i| small(Vec3::X * i as f32, 0.5))),
        (
            "nested",
            soup(3000, |i| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|v| v * 1.01_f32.powi(i as i32 - 1500))),
        ),
        ("concentric", soup(3000, |i| [-1.0, 0.5, 1.0].map(|k| Vec3::new(k, k * k, -k) * (i + 1) as f32))),
        ("far beyond comparable areas", soup(3000, |i| small(scattered(i) * 1e30, 1e28))),
        ("at the end of the range", soup(3000, |i| [-3e38, 0.0, 3e38].map(|k| scattered(i) * k))),
        ("one far away", soup(3000, |i| small(if i == 7 { Vec3::ONE * 1e37 } else { scattered(i) }, 0.01))),
        ("tiny", soup(3000, |i| small(scattered(i) * 1e-38, 1e-40))),
    ];
    for (name, shape) in cases {
        // In case of failure the name is the last thing that the test says.
        eprintln!("{name}");
        assert_holds_all(&[shape]);
    }
    assert_holds_all(&[terrain(30), soup(10, |i| small(scattered(i), 0.2)), terrain(3)]);
}

#[test]
fn the_walls_of_a_room_lie_in_leaves_of_their_own() {
    // Two triangles for each face of a cube: six leaves, where three packets would hold all.
    let walls = soup(12, |i| {
        let (axis, at) = (i as usize / 4, (i / 2 % 2) as f32);
        let corner = |u: f32, v: f32| {
            let mut p = Vec3::splat(at);
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v);
            p
        };
        [corner(0.0, 0.0), corner(1.0, 1.0), if i % 2 == 0 { corner(1.0, 0.0) } else { corner(0.0, 1.0) }]
    });
    let tree = assert_holds_all(&[walls]);
    assert_eq!((tree.nodes.len(), tree.packets.len()), (1, 6));
    assert!(tree.packets.iter().all(|p| p.used_lanes() == 2));
}

#[test]
fn nothing_makes_an_empty_tree() {
    let tree = tree_of(&[]);
    assert_eq!((tree.nodes.len(), tree.packets.len(), tree.bounds), (1, 0, None));
    assert!((0..WIDTH).all(|slot| tree.nodes[0].child_bounds(slot).is_none()));
}

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    // Enough for divisions by several threads, with zeros of both signs and ties.
    let n = (divide::SHARED * 2) as u32;
    let on_grid = |i: u32| (scattered(i) * 40.0).round() * if i.is_multiple_of(2) { 0.5 } else { -0.5 };
    let shapes =
        [soup(n, |i| [on_grid(i), on_grid(i) + Vec3::X * noise(i).powi(9), on_grid(i) + Vec3::Y * 0.1])];
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tree = pool.install(|| tree_of(&shapes));
        let nodes: Vec<_> =
            tree.nodes.iter().map(|n| (n.bounds.map(|row| row.map(f32::to_bits)), n.children)).collect();
        let packets: Vec<_> = tree.packets.iter().map(|p| (p.owners, p.prims)).collect();
        (nodes, packets)
    };
    let one = with_threads(1);
    for threads in [2, 5] {
        assert!(with_threads(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_mesh_stays_within_its_memory() {
    let shapes = [terrain(250)];
    let count = 2.0 * 250.0 * 250.0;
    let tree = assert_holds_all(&shapes);
    // Three indices a triangle, and three coordinates for every other triangle's vertex.
    let mesh = shapes[0].heap_bytes() as f64 / count;
    assert!((mesh - 18.0).abs() < 0.2, "{mesh}");
    let resident = mesh + tree.heap_bytes() as f64 / count;
    assert!(resident <= 120.0, "{resident} bytes a triangle");
    let peak = mesh + tree.peak_bytes as f64 / count;
    assert!(peak <= 220.0, "{peak} bytes a triangle while building");
}

#[test]
fn instances_lie_alone_in_their_leaves() {
    let around = |i: u32| {
        let c = if i < 50 { Vec3::ZERO } else { scattered(i) };
        Bounds3 { min: Point(c - Vec3::splat(0.1)), max: Point(c + Vec3::splat(0.1)) }
    };
    let placed: Vec<(InstanceId, Bounds3)> = (0..500).map(|i| (InstanceId(2 * i), around(i))).collect();
    let shapes = [terrain(8)];
    let tree = build(&shapes, &Layout::default(), &[ShapeId(0)], &placed).unwrap();
    assert_eq!(walked(&tree).len(), 128);
    let mut found: Vec<u32> = tree
        .items
        .iter()
        .map(|item| match item {
            Item::Instance(id) => id.0,
            Item::Prim { .. } => panic!("there are only triangles and instances"),
        })
        .collect();
    found.sort_unstable();
    assert_eq!(found, (0..500).map(|i| 2 * i).collect::<Vec<_>>());
}

#[test]
fn a_large_ground_below_small_things_hangs_at_the_root() {
    // Its two triangles have their centres among the things: no division by place keeps them apart.
    let things = soup(20_000, |i| [0.0, 0.004, 0.008].map(|k| scattered(i) * 0.5 + Vec3::new(k, k * k, -k)));
    let s = 1000.0;
    let corners = [[-s, 0.0, -s], [s, 0.0, -s], [s, 0.0, s], [-s, 0.0, s]].map(|p| Point(Vec3::from(p)));
    let ground = mesh(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    let tree = tree_of(&[things, ground]);
    let root = &tree.nodes[0];
    let holds_ground = |slot: &usize| match root.children[*slot].target() {
        Target::Packets { first, .. } if root.child_bounds(*slot).is_some() => {
            tree.packets[first as usize].owners.iter().any(|o| *o != Owner::NONE && o.shape() == ShapeId(1))
        }
        _ => false,
    };
    assert!((0..WIDTH).any(|slot| holds_ground(&slot)));
    let wide = (0..WIDTH).filter_map(|s| root.child_bounds(s)).filter(|b| b.diagonal().x > s).count();
    assert!(wide <= 2, "{wide} children of the root reach as far as the ground");
}
