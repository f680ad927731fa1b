// What pipeline/bench connectivity measures: pairs of real meshes, copies made by code, and timings.
// `remark` is what was seen on the sheet and why it is so; look again when a sheet changes.

/** Files of ../shared/meshes that a pair file joins, by the name of the case. */
export const pairs = [
  {
    file: 'cat--spot',
    remark:
      'The cat\'s tail is red: the pair has a landmark at its root, which is the tip of spot\'s stub. Spot\'s horns ' +
      'are red, since the cat has none, and the front legs, on which the cat lies.',
  },
  {
    file: 'koala--spot',
    remark:
      'Nothing wrong; orange only at the tips of spot\'s horns, which the koala lacks, and right below the ' +
      'landmark of the nose.',
  },
  {
    file: 'sphere--spot',
    remark:
      'Nothing wrong; the orange ring on the sphere is spot\'s neck, the dots are its ears and horns: they ' +
      'must come out of a round surface.',
  },
  {
    file: 'fish--plane',
    remark:
      'Red fins and wings: the fish\'s small fins become long wings, and the engines, which have no ' +
      'landmarks, are drawn out of the fish\'s flank. A red stripe where the high, short body becomes a long tube.',
  },
  {
    file: 'penguin--mh_male_baby',
    remark:
      'Red at beak and lips: the baby\'s mouth is a deep pocket that the penguin lacks (and that cuts ' +
      'itself in the source); fingers and toes have no landmarks, so they come out of the rims of flippers ' +
      'and feet.',
  },
  {
    file: 'human_man--mh_male_young',
    remark:
      'Grey but for the hands and the lips: one landmark a hand does not say which finger is which, and ' +
      'only the second body has a mouth pocket.',
  },
  {
    file: 'mhface_male_young--ict_face',
    remark:
      'Grey on the face; yellow at the corners of the eyes and at the rim, which is jagged on the first and smooth ' +
      'on the second; the second one\'s neck grows out of a short stub.',
  },
];

export const catTailTip = [1.003350019454956, 3.458050012588501, -0.15661300718784332];
export const tailRemark =
  'The same pair with the landmark of the tail at the tip of both. What is left is the shapes\' own: a long tail ' +
  'becomes a stub, a small head one that is half of the body, and horns grow.';
export const copyRemark = 'Nothing wrong; the copy\'s rounded rims are a little wavy, as even triangles made them before.';
export const fourRemark =
  'Red where one of the four has what another lacks: the cat\'s tail, the legs that are flippers on the penguin (its chest ' +
  'is drawn into them), spot\'s horns. The landmarks are only those that all four share.';

/** Names that four animals share: the penguin's own for them, and its ears, which no pair file has. */
export const penguinNames = {
  nose: 'nose', hand_l: 'front_foot_l', hand_r: 'front_foot_r', toe_l: 'hind_foot_l',
  toe_r: 'hind_foot_r', tail: 'tail_base',
};
export const penguinEars = { ear_l: [0.403, 1.0276, 0.089], ear_r: [-0.2824, 1.0127, -0.109] };

/** Who made the meshes, as their licences ask. */
export const credits = {
  cat: 'cat: billyd (thingiverse 1565405), CC BY 4.0',
  spot: 'spot: Keenan Crane, CC0',
  koala: 'koala: YahooJAPAN (thingiverse 182225), CC BY 3.0',
  plane: 'plane: YahooJAPAN (thingiverse 182252), CC BY 3.0',
  fish: 'fish: Keenan Crane ("Blub"), CC0',
  sphere: 'sphere: Oded Stein, CC BY 4.0',
  penguin: 'penguin: Oded Stein, CC BY 4.0',
  wingnut: 'wingnut: Stein, Grinspun, Crane, CC BY 4.0',
  human_man: 'human_man: Max Planck Society (SMPL body), CC BY 4.0',
  mh_male_young: 'mh_male_young: MakeHuman, CC0',
  mh_male_baby: 'mh_male_baby: MakeHuman, CC0',
  mhface_male_young: 'mhface_male_young: MakeHuman, CC0',
  ict_face: 'ict_face: (c) 2020 USC Institute for Creative Technologies, MIT',
};
